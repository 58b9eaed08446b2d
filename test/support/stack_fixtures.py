"""Fixtures of cases on the running stack: every case finds it as if it had just started."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="class", autouse=True)
def running(request, stack):
    """The stack runs before the class of a suite looks for it, in the `world` of the class."""
    stack.ensure(getattr(request.cls, "world", "empty"))


@pytest.fixture(autouse=True)
def intact(request, stack):
    """Names the case that ends a node, and starts the stack again for the next.

    `respawned` of a class: names of nodes that its cases end, and that roslaunch starts again.
    """
    stack.ensure(getattr(request.cls, "world", "empty"))
    yield
    dead = stack.deaths(getattr(request.cls, "respawned", ()))
    if dead:
        stack.broken = True
        pytest.fail(f"nodes ended in this case or the one before: {', '.join(dead)}", pytrace=False)
