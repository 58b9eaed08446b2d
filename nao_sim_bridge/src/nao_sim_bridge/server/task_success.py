"""How a task of the simulation ended, as services that answer `success` and `message` tell it."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.tasks import Task


def success_of(begin: Callable[[], Task], when_killed: str) -> tuple[bool, str]:
    """Wait for what `begin` starts, and for what that leads to.

    Args:
        begin: Starts a task, whose result may be another one.
        when_killed: What to say of a task that was ended before its time.

    Returns:
        (True, ""), or (False, what was wrong).
    """
    try:
        task: Any = begin()
        while isinstance(task, Task):
            ended, task = task, task.result()
    except (RuntimeError, ValueError, OSError) as error:
        return False, str(error)
    return (False, when_killed) if ended.killed else (True, "")
