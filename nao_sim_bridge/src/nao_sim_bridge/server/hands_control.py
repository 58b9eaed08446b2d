"""Simulated hands that touch the robot, for clients. For any thread."""

from __future__ import annotations

from typing import Any, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.arguments import number


class HandsControl:
    def __init__(self, simulation: Simulation, runner: SimulationRunner) -> None:
        self._simulation = simulation
        self._runner = runner

    def touch(self, sensors: Sequence[str], duration: float, wait: bool = True) -> Task:
        """Touch a sensor, or stroke over several.

        Args:
            sensors: Names of sensors, or of their events.
            duration: s of simulated time; see `Hands.touch`.
            wait: Whether the task ends when the hand has gone or, without a duration, when it is felt; else when the
                hand begins to come.
        """
        wanted, lasting = _names(sensors), number(duration, "duration", 0.0)

        def touch() -> Task | None:
            task = self._simulation.hands.touch(wanted, lasting)
            return task if wait else None

        return self._runner.execute(touch, "touch")

    def release(self, sensors: Sequence[str] = ()) -> Task:
        """Let go; the task ends when the hands begin to leave: those on these sensors or, if none is named, all."""
        wanted = _names(sensors)
        return self._runner.execute(lambda: self._simulation.hands.release(wanted), "release")


def _names(sensors: Any) -> list[str]:
    if not isinstance(sensors, (list, tuple)) or not all(isinstance(name, str) for name in sensors):
        raise BadValue("sensors", sensors, "a list of names")
    return list(sensors)
