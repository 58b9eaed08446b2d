"""Points and rotations in space. Pure; lengths in m, angles in rad."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple


class Point3(NamedTuple):
    """A point in a frame of /tf."""

    x: float
    y: float
    z: float
    frame: str = "torso"

    def distance_to(self, other: Sequence[float]) -> float:
        """To a point of the same frame."""
        return math.dist(self[:3], other[:3])

    def __str__(self) -> str:
        return f"({self.x:.3f}, {self.y:.3f}, {self.z:.3f}) m in {self.frame}"


class Position(NamedTuple):
    """Where something is meant to be, as plans write it: `Position(2, 3)`. A point without a heading."""

    x: float
    y: float
    z: float | None = None  # None for the default height: the eyes for the head, the floor for walking
    frame: str = ""  # of /tf; empty for the default: torso for arms and head, odom for walking


def head_angles(x: float, y: float, z: float, camera: Sequence[float]) -> tuple[float, float]:
    """HeadYaw and HeadPitch, positive to the left and down, of a head that looks at a point of the torso frame.

    `camera`: (forward, up) of the camera from the neck joint, which yaw and pitch turn about; the height of that joint
    in the torso frame; the angle by which the camera looks down.
    """
    forward, up, neck, tilt = camera
    yaw = math.atan2(y, x)
    far, high = math.hypot(x, y), z - neck
    # The camera's ray goes past the neck at a distance that does not depend on the pitch.
    past = up * math.cos(tilt) + forward * math.sin(tilt)
    away = math.hypot(far, high)
    down = math.atan2(-high, far)
    lift = math.asin(max(-1.0, min(1.0, past / away))) if away > 0.0 else 0.0
    return yaw, down + lift - tilt
