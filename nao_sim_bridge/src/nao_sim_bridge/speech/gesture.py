"""One gesture: where its joints go, and when."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping, Tuple

from nao_sim_bridge.control.joints.curves import SmoothCurve

LEG_PARTS = ("Hip", "Knee", "Ankle")


@dataclass(frozen=True)
class KeyFrames:
    """Where one joint goes: angles, rad (hands 0..1), of head and legs added to where they are.

    Their times are in s from the beginning, rising, between 0 and the length of the animation.
    """

    times: Tuple[float, ...]
    angles: Tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Animation:
    """A gesture of arms, hands and head, `length` s long, which ends where it began; some lean the trunk by the legs.

    Its name is NAOqi's path, for example "animations/Stand/Gestures/Hey_1".
    """

    name: str
    length: float
    tags: Tuple[str, ...]
    joints: Mapping[str, KeyFrames]

    def curve(self, joint: str, start: float, home: float, stretch: float) -> SmoothCurve:
        """The way of a joint that is at `start` and belongs at `home`, rad, with all times `stretch` times as long."""
        frames = self.joints[joint]
        base = home if joint.startswith("Head") or is_of_legs(joint) else 0.0
        times = [0.0, *(time * stretch for time in frames.times), self.length * stretch]
        return SmoothCurve(times, [start, *(base + angle for angle in frames.angles), home])


def is_of_legs(joint: str) -> bool:
    return any(part in joint for part in LEG_PARTS)
