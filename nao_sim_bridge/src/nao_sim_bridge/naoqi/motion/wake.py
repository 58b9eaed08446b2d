"""Part of ALMotion: waking up and going to rest."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core import sequences
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.part import MotionPart

AWAKE = "robotIsWakeUp"
EVENTS = (
    AWAKE,
    "ALMotion/Stiffness/wakeUpStarted",
    "ALMotion/Stiffness/wakeUpFinished",
    "ALMotion/Stiffness/restStarted",
    "ALMotion/Stiffness/restFinished",
)


class Wake(MotionPart):
    """Waking up, resting, and the events about it.

    Args:
        simulation: As for every part.
        runner: As for every part.
        memory: Where events go.
    """

    def __init__(self, simulation: Simulation, runner: SimulationRunner, memory: MemoryStore) -> None:
        super().__init__(simulation, runner)
        self._memory = memory
        for event in EVENTS:
            memory.declare_event(event, "ALMotion")
        memory.raise_event(AWAKE, False)

    def wakeUp(self) -> Task:
        return self._change_state("wakeUp", sequences.wake_up, awake=True)

    def rest(self, chain: str = "Body") -> Task:
        if chain != "Body":
            indices = self._indices(chain)
            return self._runner.execute(
                lambda: sequences.stiffness_task(self._robot, "rest", indices, 0.0, sequences.STIFFEN_TIME),
                "rest",
            )
        return self._change_state("rest", sequences.rest, awake=False)

    def robotIsWakeUp(self) -> bool:
        return bool(self._memory.get(AWAKE))

    def _change_state(self, name: str, sequence: Callable[..., Task], awake: bool) -> Task:
        def end() -> None:
            self._memory.raise_event(f"ALMotion/Stiffness/{name}Finished", True)
            if not awake:
                self._set_awake(False)

        def start() -> Task:
            if awake and self._robot.reflexes.wake_forbidden:
                raise NaoqiError(self._robot.reflexes.wake_forbidden)
            self._memory.raise_event(f"ALMotion/Stiffness/{name}Started", True)
            if awake:
                self._set_awake(True)
            return sequence(self._robot, lambda: self._runner.snapshot, end)

        return self._runner.execute(start, name)

    def _set_awake(self, awake: bool) -> None:
        if self._memory.get(AWAKE) != awake:
            self._memory.raise_event(AWAKE, awake)
