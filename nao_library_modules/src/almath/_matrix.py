"""Rotation matrices as (3, 3) arrays. Arrays and numbers in and out; no class of the package is known here.

Three angles (wx, wy, wz) stand for R = Rz(wz) Ry(wy) Rx(wx), in rad. Quaternions are (w, x, y, z).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Optional, Tuple

import numpy as np

Triple = Tuple[float, float, float]

# Columns shorter than this cannot be told from noise, so no axis is built on them.
_SHORTEST_COLUMN = 0.0001


def skew(v: Sequence[float]) -> np.ndarray:
    """Cross-product matrix of a vector: `skew(a) @ b` is a x b."""
    x, y, z = v
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


def axial(m: np.ndarray) -> np.ndarray:
    """Vector of the skew-symmetric part of a matrix: of a rotation, its axis times twice the sine of its angle."""
    return np.array((m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]))


def is_rotation(m: np.ndarray, epsilon: float) -> bool:
    """Tell whether the rows are unit vectors at right angles and right-handed, within `epsilon`."""
    return np.allclose(m @ m.T, np.eye(3), rtol=0.0, atol=epsilon) and abs(np.linalg.det(m) - 1.0) <= epsilon


def orthonormalised(m: np.ndarray) -> Optional[np.ndarray]:
    """Nearest right-handed frame that keeps the third column's direction and the second column's half plane.

    Returns the rotation, or None if the second and third column do not span a plane.
    """
    z = _unit(m[:, 2])
    x = None if z is None else _unit(skew(m[:, 1]) @ z)
    return None if x is None else np.column_stack((x, skew(z) @ x, z))


def _unit(v: np.ndarray) -> Optional[np.ndarray]:
    length = np.linalg.norm(v)
    # Written this way round so that a NaN is refused too.
    return v / length if length >= _SHORTEST_COLUMN else None


def about(axis: int, angle: float) -> np.ndarray:
    """Rotation by `angle`, in rad, about the coordinate axis 0, 1 or 2."""
    m, c, s = np.eye(3), math.cos(angle), math.sin(angle)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    m[first, first] = m[second, second] = c
    m[first, second], m[second, first] = -s, s
    return m


def about_axis(axis: Sequence[float], angle: float) -> np.ndarray:
    """Rotation about a unit axis by `angle`, in rad (Rodrigues' formula)."""
    c, s = math.cos(angle), math.sin(angle)
    return c * np.eye(3) + s * skew(axis) + (1.0 - c) * np.outer(axis, axis)


def from_angles(wx: float, wy: float, wz: float) -> np.ndarray:
    """Rz(wz) Ry(wy) Rx(wx), angles in rad."""
    return about(2, wz) @ about(1, wy) @ about(0, wx)


def to_angles(m: np.ndarray) -> Triple:
    """Angles (wx, wy, wz) in rad with Rz(wz) Ry(wy) Rx(wx) = m, and wy in [-pi/2, pi/2].

    Where wy is a right angle only the sum or difference of the others is defined; then wz is 0.
    """
    wz = math.atan2(m[1, 0], m[0, 0])
    # Undoing the yaw leaves Ry Rx, whose middle row (0, cos wx, -sin wx) is well defined even where wy is a
    # right angle and the last row is not.
    _, c, negative_s = (about(2, -wz) @ m)[1]
    return (math.atan2(-negative_s, c), math.atan2(-m[2, 0], math.hypot(m[0, 0], m[1, 0])), wz)


def from_quaternion(w: float, x: float, y: float, z: float) -> Optional[np.ndarray]:
    """Rotation of a quaternion of any length but zero; None for the zero quaternion."""
    square = w * w + x * x + y * y + z * z
    if square == 0.0:
        return None
    turning = skew((x, y, z))
    return np.eye(3) + (turning @ turning + w * turning) * (2.0 / square)


def to_quaternion(m: np.ndarray) -> Tuple[float, float, float, float]:
    """Unit quaternion of a rotation, with w >= 0."""
    # Row i of this symmetric matrix is the quaternion times four times its component i: the longest row is safest.
    rows = np.empty((4, 4))
    rows[0, 0] = 1.0 + np.trace(m)
    rows[0, 1:] = rows[1:, 0] = axial(m)
    rows[1:, 1:] = m + m.T + (1.0 - np.trace(m)) * np.eye(3)
    quaternion = rows[np.argmax(np.diagonal(rows))]
    quaternion /= np.linalg.norm(quaternion)
    return tuple((-quaternion if quaternion[0] < 0.0 else quaternion).tolist())
