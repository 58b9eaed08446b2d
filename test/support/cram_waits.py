"""What tests of plans wait for, and what they look at."""

from __future__ import annotations

from nao_library_modules.process_modules.control import top_level
from nao_library_modules.process_modules.flow import wait_until
from nao_library_modules.process_modules.waiting import wait_for

SHORT = 0.02
"""s in which something would happen that must not."""


def forever():
    wait_until(lambda: False)


def seen(fluent, limit=10.0):
    """The value of a fluent once it is something; from a test."""
    answer = top_level(lambda: wait_for(fluent, timeout=limit))
    assert answer, f"{fluent} did not come"
    return answer


def states(root):
    return {task.name: task.state for task in root}
