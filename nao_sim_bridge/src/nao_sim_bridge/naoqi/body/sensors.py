"""ALSensors of the simulated robot: the event about stiffness, and the methods of an extractor."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME, EVENT = "ALSensors", "BodyStiffnessChanged"
LIMP, BETWEEN, STIFF = 0, 1, 2
LIMP_BELOW, STIFF_ABOVE = 0.05, 0.95
"""Mean stiffness of the body."""


class ALSensors:
    """ALSensors as the simulated robot offers it; raises `BodyStiffnessChanged`, called after every tick."""

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        self._runner = runner
        self._memory = memory
        self._stiffnesses: Any = None
        self._level: int | None = None

    def parts(self) -> list[Any]:
        """The objects that together have the methods of ALSensors; its event is raised without subscribers, too."""
        nothing = lambda: None  # noqa: E731
        return [self, Extractor(NAME, self._memory, nothing, nothing, [EVENT])]

    def run(self) -> Any:
        # One round of what goes on at every tick anyway.
        return self._runner.execute(lambda: self._look(self._runner.snapshot), "run")

    def __call__(self, snapshot: Snapshot) -> None:
        if snapshot.stiffnesses is not self._stiffnesses:
            self._stiffnesses = snapshot.stiffnesses
            self._look(snapshot)

    def _look(self, snapshot: Snapshot) -> None:
        mean = sum(snapshot.stiffnesses) / len(snapshot.stiffnesses)
        level = LIMP if mean < LIMP_BELOW else STIFF if mean > STIFF_ABOVE else BETWEEN
        if level != self._level:
            self._level = level
            self._memory.raise_event(EVENT, level)
