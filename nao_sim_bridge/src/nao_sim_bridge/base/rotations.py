"""Rotations as plain tuples: quaternions (x, y, z, w), 3-vectors, roll-pitch-yaw with R = Rz Ry Rx. Arithmetic only."""

from __future__ import annotations

import math
from typing import Iterable, Sequence, Tuple

Vector3 = Tuple[float, float, float]
Quaternion = Tuple[float, float, float, float]


def vector3(values: Iterable[float]) -> Vector3:
    """Three numbers of any kind as plain floats."""
    x, y, z = (float(value) for value in values)
    return (x, y, z)


def plus(a: Sequence[float], b: Sequence[float]) -> Vector3:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def rotate(quaternion: Sequence[float], vector: Sequence[float]) -> Vector3:
    """`vector` of the body frame in the world frame."""
    x, y, z, w = quaternion
    vx, vy, vz = vector
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return (vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx)


def rotate_back(quaternion: Sequence[float], vector: Sequence[float]) -> Vector3:
    """`vector` of the world frame in the body frame."""
    x, y, z, w = quaternion
    return rotate((-x, -y, -z, w), vector)


def multiply(first: Sequence[float], second: Sequence[float]) -> Quaternion:
    """The rotation that turns by `second`, then by `first`."""
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def roll_pitch_yaw(quaternion: Sequence[float]) -> Vector3:
    """Roll, pitch and yaw in rad of the orientation."""
    x, y, z, w = quaternion
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return (roll, pitch, yaw)


def from_roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Quaternion of the rotation Rz(yaw) Ry(pitch) Rx(roll)."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def cross(a: Sequence[float], b: Sequence[float]) -> Vector3:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def angular_velocity(before: Sequence[float], after: Sequence[float], seconds: float) -> Vector3:
    """Constant angular velocity, rad/s in world, that turns one orientation into another the short way round."""
    bx, by, bz, bw = before
    x, y, z, w = multiply(after, (-bx, -by, -bz, bw))
    sine = math.sqrt(x * x + y * y + z * z)
    if sine == 0.0:
        return (0.0, 0.0, 0.0)
    rate = 2.0 * math.atan2(math.copysign(sine, w), abs(w)) / (sine * seconds)
    return (rate * x, rate * y, rate * z)
