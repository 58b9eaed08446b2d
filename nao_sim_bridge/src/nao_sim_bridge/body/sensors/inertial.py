"""The inertial unit in the torso: what accelerometer and gyroscope of the chest board feel."""

from __future__ import annotations

import math
from typing import Sequence

from nao_sim_bridge.base.readings import BodyReadings
from nao_sim_bridge.base.rotations import Vector3, cross, roll_pitch_yaw, rotate, rotate_back, vector3
from nao_sim_bridge.body.sensors.snapshot import Imu


class InertialUnit:
    """Accelerometer and gyroscope at a fixed place of the torso.

    Args:
        place: (3,) of the accelerometer in the torso frame, m.
        gravity: m/s2.
        heading: Of the robot when it was started, rad: headings count from there.
    """

    def __init__(self, place: Sequence[float], gravity: float, heading: float = 0.0) -> None:
        self._place = vector3(place)
        self._gravity = gravity
        self._heading = heading
        self._velocity: Vector3 | None = None

    def reset(self) -> None:
        """Forget the last velocity: the robot was put somewhere else."""
        self._velocity = None

    def read(self, body: BodyReadings, dt: float) -> Imu:
        """Reading after `dt` seconds since the last one."""
        turn = body.pose.orientation
        swing = cross(body.angular_velocity, rotate(turn, self._place))
        velocity = tuple(v + s for v, s in zip(body.linear_velocity, swing))
        before = self._velocity if self._velocity is not None else velocity
        self._velocity = velocity
        ax, ay, az = ((v - b) / dt for v, b in zip(velocity, before))
        # An accelerometer feels what holds it up, so gravity counts upwards.
        felt = rotate_back(turn, (ax, ay, az + self._gravity))
        angles = roll_pitch_yaw(turn)
        if self._heading:
            angles = (angles[0], angles[1], math.remainder(angles[2] - self._heading, 2.0 * math.pi))
        return Imu(felt, rotate_back(turn, body.angular_velocity), angles)
