"""What the engine and the sensors report: small immutable values, without any behaviour."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Tuple

from nao_sim_bridge.base.rotations import Quaternion, Vector3, rotate_back

UP = (0.0, 0.0, 1.0)
FALLEN = 1.0
"""Lean of the torso from which on a robot has fallen, rad."""


@dataclass(frozen=True)
class Pose:
    """Position (m) and orientation (quaternion x, y, z, w) of a body in world."""

    position: Vector3
    orientation: Quaternion

    @property
    def lean(self) -> float:
        """Angle between the body and upright, rad: 0 stands straight, pi is head down."""
        x, y, z = rotate_back(self.orientation, UP)
        return math.atan2(math.hypot(x, y), z)


@dataclass(frozen=True)
class JointReadings:
    """What the joints measure: (26,) angles in rad (hands 0..1), speeds in rad/s, motor torques in N m."""

    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    torques: tuple[float, ...]


@dataclass(frozen=True)
class BodyReadings:
    """True motion of the torso frame in world: pose, velocity in m/s, angular velocity in rad/s."""

    pose: Pose
    linear_velocity: Vector3
    angular_velocity: Vector3


class Contact(NamedTuple):
    """One point where something presses on the robot.

    Attributes:
        link: Link index of PyBullet (-1 is the torso).
        position: In world, m.
        normal: Unit vector in world, towards the robot.
        force: N, along the normal.
    """

    link: int
    position: Vector3
    normal: Vector3
    force: float


@dataclass(frozen=True)
class FootForces:
    """The four force sensors under one foot.

    Attributes:
        forces: Front left, front right, rear left, rear right, in N.
        total: Their sum, N.
        center_of_pressure: x and y in the foot frame, m; (0, 0) without load.
    """

    forces: Tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    total: float = 0.0
    center_of_pressure: Tuple[float, float] = (0.0, 0.0)
