"""Where sounds come from, while somebody wants to know. No ROS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError, UnknownModule

from ...robot.event_relay import EventRelay
from ...ros.health import Report
from ..base.lazy_subscription import LazySubscription

MODULES = ("ALSoundLocalization", "ALAudioSourceLocalization")
"""Newer name first."""
ENERGY = "EnergyComputation"
ANSWER_LIMIT = 2.0


@dataclass(frozen=True)
class Direction:
    """Where a sound came from."""

    time: float  # s, the robot's clock
    azimuth: float  # rad, in the frame of the head, positive to the left
    elevation: float  # rad, positive upwards
    confidence: float  # 0 to 1
    energy: float  # as the robot reports it
    head_in_torso: tuple[float, ...]  # x, y, z in m, roll, pitch, yaw in rad, at that time


def read_direction(value: Any) -> Direction | None:
    """Direction from an event, [[s, us], [azimuth, elevation, confidence, energy], head in torso, head in robot].

    None for an event without one.
    """
    if not isinstance(value, (list, tuple)) or len(value) < 3 or len(value[1]) < 3 or len(value[2]) != 6:
        return None
    azimuth, elevation, confidence, *energy = (float(each) for each in value[1])
    stamp = value[0][0] + 1e-6 * value[0][1]
    pose = tuple(float(each) for each in value[2])
    return Direction(stamp, azimuth, elevation, confidence, energy[0] if energy else 0.0, pose)


class SoundDirections:
    """Has the robot locate sounds while that is wanted, also after a lost connection."""

    def __init__(self, robot: Any, subscriber: str, sensitivity: float, sink: Callable[[Direction], None]) -> None:
        """Start idle; the robot need not be connected yet.

        Args:
            subscriber: Name of the subscriber at the robot.
            sensitivity: 0 to 1; below 0 leaves the robot's own.
            sink: Gets each direction, in a thread of libqi.
        """
        self._robot = robot
        self._subscriber = subscriber
        self._sensitivity = sensitivity
        self._sink = sink
        self._module = MODULES[0]
        self._relay = EventRelay(lambda: robot.proxy("ALMemory"), self._on_event)
        self._locating = LazySubscription(robot, "sound localisation", self._begin, self._end)

    def want(self, wanted: bool) -> None:
        self._locating.want(wanted)

    def report(self) -> Report:
        values = {"module": self._module}
        return self._locating.report("nobody listens", "sounds are located", "sounds cannot be located", values)

    def close(self) -> None:
        self._locating.close()

    def _begin(self) -> None:
        self._module = self._find_module()
        self._ask("setParameter", ENERGY, True)
        if self._sensitivity >= 0.0:
            self._ask("setParameter", "Sensitivity", self._sensitivity)
        self._relay.close()  # events of a connection that was lost
        self._relay.subscribe(f"{self._module}/SoundLocated")
        self._ask("subscribe", self._subscriber)

    def _end(self) -> None:
        self._relay.close()
        self._ask("unsubscribe", self._subscriber)

    def _find_module(self) -> str:
        """The module that this robot has; raises NaoError if it has neither, or cannot be asked."""
        missing: NaoError | None = None
        for module in MODULES:
            try:
                self._robot.proxy(module).call_async("ping").result(timeout=ANSWER_LIMIT)
            except UnknownModule as error:
                missing = missing or error
            else:
                return module
        raise missing or NaoError("there is no module that locates sounds")

    def _ask(self, method: str, *arguments: Any) -> None:
        self._robot.proxy(self._module).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)

    def _on_event(self, _name: str, value: Any) -> None:
        direction = read_direction(value)
        if direction is not None:
            self._sink(direction)
