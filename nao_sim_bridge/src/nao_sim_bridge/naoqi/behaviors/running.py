"""The behaviours that run: what ALBehaviorManager, ALAnimationPlayer and autonomous life have in common."""

from __future__ import annotations

import logging
from typing import Callable, Iterable

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.behaviors.player import BehaviorPlayer
from nao_sim_bridge.behaviors.steps import Behavior
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore

log = logging.getLogger("nao_sim.behaviors")
RUN = "BehaviorsRun"


class RunningBehaviors:
    """Starts and stops behaviours, and tells which of them run. Simulation thread only, but for `names`.

    Attributes:
        installed: What there is.
        ended: Called with the name of each that has ended, and whether it came to its end by itself.
    """

    def __init__(self, player: BehaviorPlayer, installed: InstalledBehaviors, memory: MemoryStore) -> None:
        self.installed = installed
        self.ended: list[Callable[[str, bool], None]] = []
        self._player = player
        self._memory = memory
        self._tasks: dict[str, Task] = {}

    @property
    def names(self) -> list[str]:
        """Those that run, first begun first. Any thread."""
        return list(self._tasks)

    def start(self, behavior: Behavior) -> Task:
        """Begin with a behaviour; its task ends with it.

        A NaoqiError when it runs already or too many do, a BehaviorFailed when its first step cannot be done.
        """
        if behavior.name in self._tasks:
            raise NaoqiError(f"{behavior.name} runs already")
        most = load_sizes().behaviors.running
        if len(self._tasks) >= most:
            raise NaoqiError(f"{most} behaviors run at most at the same time: stopBehavior or stopAllBehaviors first")
        task = self._player.start(behavior)
        if task.finished and task.error is not None:
            raise task.error
        self._tasks[behavior.name] = task
        self._tell()
        task.add_done_callback(lambda done: self._over(behavior.name, done))
        return task

    def stop(self, name: str) -> None:
        """Stop a behaviour; a NaoqiError when it does not run."""
        if name not in self._tasks:
            known = ", ".join(self._tasks) or "none"
            raise NaoqiError(f"{name} does not run; running is {known}")
        self._tasks[name].kill()

    def stop_those(self, names: Iterable[str]) -> None:
        """Stop those of them that run."""
        for name in set(names) & set(self._tasks):
            self.stop(name)

    def stop_all(self) -> None:
        for task in list(self._tasks.values()):
            task.kill()

    def _over(self, name: str, done: Task) -> None:
        del self._tasks[name]
        if done.error is not None:
            log.warning("%s", done.error)
        self._tell()
        for call in self.ended:
            call(name, done.error is None and not done.killed)

    def _tell(self) -> None:
        self._memory.raise_event(RUN, self.names)
