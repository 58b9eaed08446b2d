"""Where sounds come from, while somebody wants to know. No ROS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import UnknownModule

from ..base.extractor import Extractor, ExtractorKind

STATES = ("nobody listens", "sounds are located", "sounds cannot be located")
LOCALISATION_KINDS = [
    ExtractorKind("sound localisation", module, f"{module}/SoundLocated", states=STATES)
    for module in ("ALSoundLocalization", "ALAudioSourceLocalization")
]
"""Newer name first."""
ENERGY = "EnergyComputation"


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


class SoundDirections(Extractor):
    """Has the robot locate sounds while that is wanted, also after a lost connection."""

    answer_limit = 2.0

    def __init__(self, robot: Any, subscriber: str, sensitivity: float, sink: Callable[[Direction], None]) -> None:
        """Start idle; the robot need not be connected yet.

        Args:
            subscriber: Name of the subscriber at the robot.
            sensitivity: 0 to 1; below 0 leaves the robot's own.
            sink: Gets each direction, in a thread of libqi.
        """
        self._sensitivity = sensitivity
        self._tell = sink
        super().__init__(robot, LOCALISATION_KINDS[0], subscriber, self._take, self._set_up)

    def _set_up(self) -> None:
        self._choose_kind()
        self.call("setParameter", ENERGY, True)
        if self._sensitivity >= 0.0:
            self.call("setParameter", "Sensitivity", self._sensitivity)

    def _choose_kind(self) -> None:
        """Choose the module that this robot has; raises NaoError if it has neither, or cannot be asked."""
        missing = []
        for kind in LOCALISATION_KINDS:
            self.kind = kind
            try:
                self.call("ping")
                return
            except UnknownModule as error:
                missing.append(error)
        self.kind = LOCALISATION_KINDS[0]
        raise missing[0]

    def _take(self, value: Any) -> None:
        direction = read_direction(value)
        if direction is not None:
            self._tell(direction)
