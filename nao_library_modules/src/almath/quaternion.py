"""Rotations as quaternions."""

from __future__ import annotations

import math

from almath import _matrix
from almath._components import Vector, answer, require
from almath.errors import AlmathError
from almath.positions import Position3D

# Below this sine of half the angle there is no axis worth the name; X stands in.
_SMALLEST_SINE = 1e-9


class Quaternion(Vector):
    """The quaternion w + xi + yj + zk; of length 1 it is a rotation. Made from nothing it is the identity."""

    w: float
    x: float
    y: float
    z: float

    _defaults = (1.0, 0.0, 0.0, 0.0)

    def __mul__(self, other: Quaternion | Position3D | float) -> Quaternion | Position3D:
        """Chain two rotations, turn a point, or multiply by a number."""
        if isinstance(other, Quaternion):
            mine, theirs = (self.x, self.y, self.z), (other.x, other.y, other.z)
            turned = _matrix.cross(mine, theirs)
            vector = (self.w * b + other.w * a + c for a, b, c in zip(mine, theirs, turned))
            return self._make((self.w * other.w - _matrix.dot(mine, theirs), *vector))
        if isinstance(other, Position3D):
            rows = _matrix.from_quaternion(*self._values())
            if rows is None:
                raise AlmathError(f"{self!r} turns nothing: its norm is zero")
            return other._make(_matrix.applied(rows, tuple(other._values())))
        return super().__mul__(other)

    def isNear(self, other: Quaternion, epsilon: float = 0.0001) -> bool:
        """Tell whether both are the same rotation, each component within `epsilon`; q and -q are the same."""
        require(other, Quaternion, "Quaternion.isNear")
        return super().isNear(other, epsilon) or super().isNear(other * -1.0, epsilon)

    def inverse(self) -> Quaternion:
        """Conjugate, which is the inverse rotation of a quaternion of length 1."""
        return self._make((self.w, -self.x, -self.y, -self.z))

    @staticmethod
    def fromAngleAndAxisRotation(angle: float, axis_x: float, axis_y: float, axis_z: float) -> Quaternion:
        """Rotation by `angle` rad about an axis of any length but zero."""
        axis = Position3D(axis_x, axis_y, axis_z).normalize() * math.sin(angle / 2.0)
        return Quaternion(math.cos(angle / 2.0), axis.x, axis.y, axis.z)


quaternionFromAngleAndAxisRotation = Quaternion.fromAngleAndAxisRotation


def quaternionInverse(quaternion: Quaternion, out: Quaternion | None = None) -> Quaternion | None:
    """Inverse of a quaternion of length 1; written to `out` if that is given."""
    require(quaternion, Quaternion, "quaternionInverse")
    return answer(quaternion.inverse(), out, "quaternionInverse")


def angleAndAxisRotationFromQuaternion(quaternion: Quaternion) -> list[float]:
    """Angle and axis of a rotation.

    Args:
        quaternion: Of any length but zero.

    Returns:
        The angle in rad in [0, 2 pi], then the three components of the unit axis; the X axis if nothing
        turns.
    """
    require(quaternion, Quaternion, "angleAndAxisRotationFromQuaternion")
    quaternion = quaternion.normalize()
    vector = (quaternion.x, quaternion.y, quaternion.z)
    sine = math.sqrt(_matrix.dot(vector, vector))
    axis = _matrix.scaled(vector, 1.0 / sine) if sine > _SMALLEST_SINE else (1.0, 0.0, 0.0)
    return [2.0 * math.atan2(sine, quaternion.w), *axis]
