"""The calls of a module that take simulated time and have not ended: how many there may be."""

from __future__ import annotations

import re

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

ENDING = re.compile("stop|kill|rest|exit|clean|delete|remove|release|unsubscribe|unregister|unload|flush|setStiffness")
"""What methods begin with that end something: whoever has too many calls under way can still make as many of these."""


class Unfinished:
    """Tasks that have not ended, and those that they led to. Any thread."""

    def __init__(self) -> None:
        self._tasks: set[Task] = set()

    def require_room(self, method: str) -> None:
        """Raise a NaoqiError when there are too many of them for another call of this method."""
        most = load_sizes().clients.unfinished_calls
        if len(self._tasks) >= (2 * most if ENDING.match(method) else most):
            raise NaoqiError(f"{len(self._tasks)} calls of this module have not ended: {most} at most")

    def note(self, task: Task) -> None:
        """Count a task until it has ended, then the one that is its result."""
        self._tasks.add(task)
        task.add_done_callback(self._over)

    def kill_all(self) -> None:
        """End all of them, as if they had been killed."""
        while self._tasks:
            task = self._tasks.pop()
            task.killed = task.killed or not task.finished
            task.finish()

    def _over(self, task: Task) -> None:
        self._tasks.discard(task)
        if isinstance(task.value, Task):
            self.note(task.value)
