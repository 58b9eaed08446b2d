"""What the simulated robot senses at one tick, immutable: services and nodes read it from any thread."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Mapping, Tuple

from nao_sim_bridge.sim.rotations import Quaternion, Vector3, rotate_back


@dataclass(frozen=True)
class Pose:
    """Position (m) and orientation (quaternion x, y, z, w) of a body in world."""

    position: Vector3
    orientation: Quaternion


@dataclass(frozen=True)
class Imu:
    """The inertial unit in the torso.

    Attributes:
        accelerometer: Proper acceleration in the torso frame, m/s2; (0, 0, 9.81) when upright and at rest.
        gyroscope: Angular velocity in the torso frame, rad/s.
        angles: Roll, pitch and yaw of the torso in world, rad.
    """

    accelerometer: Vector3
    gyroscope: Vector3
    angles: Vector3


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


@dataclass(frozen=True)
class Snapshot:
    """State after one tick. Joint arrays are in ALMotion's Body order (26,).

    Attributes:
        tick: Number of ticks since the start of the program; never goes back, not even at a reset.
        time: Simulated time, s.
        positions: Measured joint angles, rad (hands 0..1).
        velocities: Measured joint speeds, rad/s.
        torques: Torque of each motor, N m.
        currents: Electric current of each motor, A, absolute.
        temperatures: Motor temperatures, degC.
        commands: Commanded joint angles, rad.
        stiffnesses: 0..1.
        torso: True pose of the torso in world.
        linear_velocity: True velocity of the torso in world, m/s.
        angular_velocity: True angular velocity of the torso in world, rad/s.
        imu: The inertial unit.
        left_foot: Force sensors of the left foot.
        right_foot: Force sensors of the right foot.
        touched: Names of touch sensors, bumpers and buttons that something presses (names of the robot model).
        sonars: Echo distances left and right, m.
        battery_charge: 0..1.
        battery_current: A, positive while it discharges.
        objects: True poses of the world's movable objects, by name.
    """

    tick: int
    time: float
    positions: Tuple[float, ...]
    velocities: Tuple[float, ...]
    torques: Tuple[float, ...]
    currents: Tuple[float, ...]
    temperatures: Tuple[float, ...]
    commands: Tuple[float, ...]
    stiffnesses: Tuple[float, ...]
    torso: Pose
    linear_velocity: Vector3
    angular_velocity: Vector3
    imu: Imu
    left_foot: FootForces
    right_foot: FootForces
    touched: frozenset = frozenset()
    sonars: Tuple[float, float] = (0.0, 0.0)
    battery_charge: float = 1.0
    battery_current: float = 0.0
    objects: Mapping[str, Pose] = field(default_factory=dict)

    @property
    def velocity_in_torso(self) -> Vector3:
        """True velocity of the torso in its own frame, m/s."""
        return rotate_back(self.torso.orientation, self.linear_velocity)
