"""What the engine and the sensors report: small immutable values, without any behaviour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Tuple

from nao_sim_bridge.base.rotations import Quaternion, Vector3


@dataclass(frozen=True)
class Pose:
    """Position (m) and orientation (quaternion x, y, z, w) of a body in world."""

    position: Vector3
    orientation: Quaternion


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
