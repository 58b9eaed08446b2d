"""Rotations as a matrix and as three angles."""

from __future__ import annotations

import math
from collections.abc import Iterable

from almath import _matrix
from almath._components import Linear, Turning, as_number, as_numbers, asking, require
from almath.errors import AlmathError
from almath.positions import Position3D, Velocity3D

# How far from 1 the square of an axis' length may be before it is refused instead of taken for rounding.
_AXIS_TOLERANCE = 0.00001


class Rotation(Turning):
    """A 3x3 rotation matrix; `r2_c3` is row 2, column 3.

    Made from nothing it is the identity. A sequence of 9 numbers is the matrix row by row; of one of 12 or 16
    (a Transform as a list) the rotation is taken.
    """

    _names = tuple(f"r{row}_c{column}" for row in (1, 2, 3) for column in (1, 2, 3))
    _defaults = tuple(number for row in _matrix.IDENTITY for number in row)

    @classmethod
    def _read(cls, arguments: tuple[object, ...]) -> Iterable[float]:
        if not arguments:
            return cls._defaults
        if len(arguments) != 1:
            raise AlmathError(f"Rotation takes one sequence of 9, 12 or 16 numbers, got {len(arguments)} arguments")
        if isinstance(arguments[0], Rotation):
            return arguments[0]._values()
        numbers = as_numbers(arguments[0], "Rotation")
        if len(numbers) in (12, 16):
            return [*numbers[0:3], *numbers[4:7], *numbers[8:11]]
        if len(numbers) != 9:
            raise AlmathError(f"Rotation takes 9, 12 or 16 numbers, got {len(numbers)}: {numbers}")
        return numbers

    def __mul__(self, other: Rotation | Position3D | Velocity3D) -> Rotation | Position3D | Velocity3D:
        """Chain two rotations, or turn a point or a velocity."""
        if isinstance(other, Rotation):
            return self._from_rows(_matrix.product(self._rows(), other._rows()))
        if isinstance(other, (Position3D, Velocity3D)):
            return other._make(_matrix.applied(self._rows(), tuple(other._values())))
        return NotImplemented

    def isRotation(self, epsilon: float = 0.0001) -> bool:
        """Tell whether the rotation is orthonormal and right-handed, within `epsilon`."""
        return self._is_rotation(epsilon)

    def normalizeRotation(self) -> None:
        """Make the rotation one again; its third column keeps its direction.

        Raises AlmathError if the second and third column do not span a plane.
        """
        self._normalize()

    def transpose(self) -> Rotation:
        """Swap rows and columns: the inverse of a rotation."""
        return self._from_rows(_matrix.transposed(self._rows()))

    @staticmethod
    def fromQuaternion(w: float, x: float, y: float, z: float) -> Rotation:
        """Rotation of the quaternion w + xi + yj + zk, of any length but zero."""
        rows = _matrix.from_quaternion(w, x, y, z)
        if rows is None:
            raise AlmathError("Rotation.fromQuaternion takes a quaternion other than zero")
        return Rotation._from_rows(rows)

    @staticmethod
    def fromAngleDirection(angle: float, x: float, y: float, z: float) -> Rotation:
        """Rotation by `angle` rad about the unit vector (x, y, z)."""
        square = x * x + y * y + z * z
        if not abs(square - 1.0) <= _AXIS_TOLERANCE:
            raise AlmathError(f"the axis of a rotation must have length 1, got ({x}, {y}, {z})")
        return Rotation._from_rows(_matrix.about_axis((x, y, z), angle))

    # The quarter and half turns are written out because cos(pi / 2) is not exactly 0 in floating point.

    @staticmethod
    def fromRotXPi() -> Rotation:
        """Half a turn about X, without rounding."""
        return Rotation([1, 0, 0, 0, -1, 0, 0, 0, -1])

    @staticmethod
    def fromRotYPi() -> Rotation:
        """Half a turn about Y, without rounding."""
        return Rotation([-1, 0, 0, 0, 1, 0, 0, 0, -1])

    @staticmethod
    def fromRotZPi() -> Rotation:
        """Half a turn about Z, without rounding."""
        return Rotation([-1, 0, 0, 0, -1, 0, 0, 0, 1])

    @staticmethod
    def fromRotZHalfPi() -> Rotation:
        """Quarter of a turn about Z, without rounding."""
        return Rotation([0, -1, 0, 1, 0, 0, 0, 0, 1])


class Rotation3D(Linear):
    """Three angles that stand for R = Rz(wz) Ry(wy) Rx(wx).

    Sums and multiples are those of the numbers, not of the rotations.
    """

    wx: float  # rad
    wy: float  # rad
    wz: float  # rad

    def norm(self) -> float:
        """Root of the sum of the squares, in rad; not the angle of the rotation."""
        return math.sqrt(sum(value * value for value in self._values()))


rotationFromRotX, rotationFromRotY, rotationFromRotZ = Rotation.fromRotX, Rotation.fromRotY, Rotation.fromRotZ
rotationFrom3DRotation = Rotation.from3DRotation


def rotationFromAngleDirection(angle: float, *axis: float | Position3D) -> Rotation:
    """Rotation by `angle` rad about a unit vector, given as a Position3D or as three numbers."""
    if len(axis) == 1 and isinstance(axis[0], Position3D):
        axis = tuple(axis[0]._values())
    if len(axis) != 3:
        raise AlmathError(f"rotationFromAngleDirection takes an angle and a Position3D or three numbers, got {axis!r}")
    return Rotation.fromAngleDirection(angle, *axis)


normalizeRotation = asking("normalizeRotation", (Rotation,), Rotation.normalizeRotation.__doc__)


def applyRotation(rotation: Rotation, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Turn a point; the coordinates of the turned one.

    In C++ this overwrites three numbers, which Python cannot do.
    """
    require(rotation, Rotation, "applyRotation")
    point = tuple(as_number(value, f"applyRotation {name}") for name, value in zip("xyz", (x, y, z)))
    return _matrix.applied(rotation._rows(), point)


def rotationFromAxesXYZ(x_axis: Position3D, y_axis: Position3D, z_axis: Position3D) -> Rotation:
    """Rotation whose columns are three given unit vectors.

    Raises AlmathError if they are not of length 1, at right angles and right-handed.
    """
    for axis in (x_axis, y_axis, z_axis):
        require(axis, Position3D, "rotationFromAxesXYZ")
    rotation = Rotation._from_rows(_matrix.transposed(tuple(tuple(a._values()) for a in (x_axis, y_axis, z_axis))))
    if not rotation.isRotation(0.001):
        raise AlmathError(f"{x_axis!r}, {y_axis!r}, {z_axis!r} are not three right-handed unit vectors at right angles")
    return rotation


def rotationFromAxesXY(x_axis: Position3D, y_axis: Position3D) -> Rotation:
    """Rotation whose first two columns are given unit vectors at right angles."""
    require(x_axis, Position3D, "rotationFromAxesXY")
    return rotationFromAxesXYZ(x_axis, y_axis, x_axis.crossProduct(y_axis))


def rotationFromAxesXZ(x_axis: Position3D, z_axis: Position3D) -> Rotation:
    """Rotation whose first and third columns are given unit vectors at right angles."""
    require(z_axis, Position3D, "rotationFromAxesXZ")
    return rotationFromAxesXYZ(x_axis, z_axis.crossProduct(x_axis), z_axis)


def rotationFromAxesYZ(y_axis: Position3D, z_axis: Position3D) -> Rotation:
    """Rotation whose last two columns are given unit vectors at right angles."""
    require(y_axis, Position3D, "rotationFromAxesYZ")
    return rotationFromAxesXYZ(y_axis.crossProduct(z_axis), y_axis, z_axis)
