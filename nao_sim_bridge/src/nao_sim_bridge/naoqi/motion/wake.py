"""Part of ALMotion: waking up and going to rest."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core import posture_change, sequences
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.part import MotionPart

AWAKE, STATES = "robotIsWakeUp", "ALMotion/Stiffness/"


def set_awake(memory: MemoryStore, awake: bool) -> None:
    """Raise the event about being awake, unless it has said so already."""
    if memory.get(AWAKE) != awake:
        memory.raise_event(AWAKE, awake)


class Wake(MotionPart):
    """Waking up, resting, and the events about it."""

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        super().__init__(runner)
        self._memory = memory
        memory.declare_event(AWAKE, "ALMotion")
        for event in ("wakeUpStarted", "wakeUpFinished", "restStarted", "restFinished"):
            memory.declare_event(f"{STATES}{event}", "ALMotion")
        memory.raise_event(AWAKE, False)

    def wakeUp(self) -> Task:
        return self._change_state("wakeUp", sequences.wake_up, awake=True)

    def rest(self, chain: str = "Body") -> Task:
        if chain != "Body":
            indices = self._indices(chain)
            return self._runner.execute(
                lambda: sequences.stiffness_task(self._robot, "rest", indices, 0.0, sequences.STIFFEN_TIME), "rest"
            )
        return self._change_state("rest", posture_change.rest, awake=False)

    def robotIsWakeUp(self) -> bool:
        return bool(self._memory.get(AWAKE))

    def _change_state(self, name: str, sequence: Callable[..., Task], awake: bool) -> Task:
        def end() -> None:
            self._memory.raise_event(f"{STATES}{name}Finished", True)
            if not awake:
                set_awake(self._memory, False)

        def start() -> Task:
            if awake and self._robot.reflexes.wake_forbidden:
                raise NaoqiError(self._robot.reflexes.wake_forbidden)
            self._memory.raise_event(f"{STATES}{name}Started", True)
            if awake:
                set_awake(self._memory, True)
            return sequence(self._robot, lambda: self._runner.snapshot, end)

        return self._runner.execute(start, name)
