"""Rotations as a matrix, as three angles and as a quaternion; homogeneous transforms and displacements."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real

import numpy as np

from almath import _matrix
from almath._components import (
    AlmathError,
    Components,
    Linear,
    Placed,
    Turning,
    Vector,
    answer,
    as_number,
    as_numbers,
    asking,
    fill,
    require,
)
from almath.positions import Position2D, Position3D, Velocity3D, Velocity6D

# How far from 1 the square of an axis' length may be before it is refused instead of taken for rounding.
_AXIS_TOLERANCE = 0.00001


class Rotation(Turning):
    """A 3x3 rotation matrix; `r2_c3` is row 2, column 3.

    Made from nothing it is the identity. A sequence of 9 numbers is the matrix row by row; of one of 12 or 16
    (a Transform as a list) the rotation is taken.
    """

    _names = tuple(f"r{row}_c{column}" for row in (1, 2, 3) for column in (1, 2, 3))
    _defaults = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

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
            return self._from_rows(self._rows() @ other._rows())
        if isinstance(other, (Position3D, Velocity3D)):
            return other._make(self._rows() @ other._values())
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
        return self._from_rows(self._rows().T)

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
        return math.hypot(*self._values())


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
    return tuple((rotation._rows() @ point).tolist())


def rotationFromAxesXYZ(x_axis: Position3D, y_axis: Position3D, z_axis: Position3D) -> Rotation:
    """Rotation whose columns are three given unit vectors.

    Raises AlmathError if they are not of length 1, at right angles and right-handed.
    """
    for axis in (x_axis, y_axis, z_axis):
        require(axis, Position3D, "rotationFromAxesXYZ")
    rotation = Rotation._from_rows(np.column_stack([axis._values() for axis in (x_axis, y_axis, z_axis)]))
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
            aw, ax, ay, az = self._values()
            bw, bx, by, bz = other._values()
            return self._make(
                (
                    aw * bw - ax * bx - ay * by - az * bz,
                    aw * bx + ax * bw + ay * bz - az * by,
                    aw * by - ax * bz + ay * bw + az * bx,
                    aw * bz + ax * by - ay * bx + az * bw,
                )
            )
        if isinstance(other, Position3D):
            rows = _matrix.from_quaternion(*self._values())
            if rows is None:
                raise AlmathError(f"{self!r} turns nothing: its norm is zero")
            return other._make(rows @ other._values())
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
    sine = math.hypot(*vector)
    axis = [value / sine for value in vector] if sine > _SMALLEST_SINE else (1.0, 0.0, 0.0)
    return [2.0 * math.atan2(sine, quaternion.w), *axis]


_LAST_ROW = (0.0, 0.0, 0.0, 1.0)


class Transform(Turning, Placed):
    """Rotation and translation of one frame in another; `r2_c3` is row 2, column 3, and column 4 is in m.

    Made from nothing it is the identity, from three numbers a translation. A sequence of 12 or 16 numbers is
    the matrix row by row, as ALMotion.getTransform returns it; a rotation that is off by rounding is made
    orthonormal.
    """

    _names = tuple(f"r{row}_c{column}" for row in (1, 2, 3) for column in (1, 2, 3, 4))
    _defaults = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)

    @classmethod
    def _read(cls, arguments: tuple[object, ...]) -> Iterable[float]:
        if not arguments:
            return cls._defaults
        if len(arguments) == 3:
            position = [as_number(value, f"Transform {name}") for name, value in zip("xyz", arguments)]
            return cls._from_parts(np.eye(3), position)._values()
        if len(arguments) != 1 or isinstance(arguments[0], Real):
            raise AlmathError(f"Transform takes 3 numbers or a sequence of 12 or 16, got {len(arguments)} arguments")
        if isinstance(arguments[0], Transform):
            return arguments[0]._values()
        numbers = as_numbers(arguments[0], "Transform")
        if len(numbers) not in (12, 16):
            raise AlmathError(f"Transform takes 12 or 16 numbers, got {len(numbers)}: {numbers}")
        transform = cls._make(numbers[:12])
        if not transform.isTransform():
            transform.normalizeTransform()
        return transform._values()

    @classmethod
    def _from_parts(cls, rows: np.ndarray, position: Iterable[float]) -> Transform:
        return cls._make(np.column_stack((rows, position)).ravel().tolist())

    @classmethod
    def _from_rows(cls, rows: np.ndarray) -> Transform:
        return cls._from_parts(rows, (0.0, 0.0, 0.0))

    def _with_rows(self, rows: np.ndarray) -> Transform:
        return self._from_parts(rows, self._point())

    def _point(self) -> _matrix.Triple:
        return (self.r1_c4, self.r2_c4, self.r3_c4)

    def _placed(self, point: _matrix.Triple) -> np.ndarray:
        return self._rows() @ point + self._point()

    def __mul__(self, other: Transform | Position3D | Position2D) -> Transform | Position3D:
        """Chain two transforms, or place a point; one of the plane is taken at z = 0."""
        if isinstance(other, Transform):
            return self._from_parts(self._rows() @ other._rows(), self._placed(other._point()))
        if isinstance(other, Position3D):
            return Position3D(self._placed((other.x, other.y, other.z)))
        if isinstance(other, Position2D):
            return Position3D(self._placed((other.x, other.y, 0.0)))
        return NotImplemented

    def isTransform(self, epsilon: float = 0.0001) -> bool:
        """Tell whether the rotation is orthonormal and right-handed, within `epsilon`."""
        return self._is_rotation(epsilon)

    def normalizeTransform(self) -> None:
        """Make the rotation one again; its third column keeps its direction.

        Raises AlmathError if the second and third column do not span a plane.
        """
        self._normalize()

    def norm(self) -> float:
        """Length of the translation, in m."""
        return math.hypot(*self._point())

    def inverse(self) -> Transform:
        """Transform that undoes this one."""
        rows = self._rows().T
        return self._from_parts(rows, -rows @ self._point())

    def diff(self, other: Transform) -> Transform:
        """Transform that leads from here to `other`, in this frame."""
        require(other, Transform, "Transform.diff")
        return self.inverse() * other

    def toVector(self, out: list[float] | None = None) -> list[float] | None:
        """List the 16 numbers of the 4x4 matrix, row by row, or write them to `out`."""
        numbers = [*self._values(), *_LAST_ROW]
        if out is None:
            return numbers
        out[:] = numbers
        return None

    @staticmethod
    def fromPosition(x: float, y: float, z: float, wx: float = 0.0, wy: float = 0.0, wz: float = 0.0) -> Transform:
        """Translation in m and, if given, rotation Rz(wz) Ry(wy) Rx(wx) in rad."""
        return Transform._from_parts(_matrix.from_angles(wx, wy, wz), (x, y, z))


transformFromRotX, transformFromRotY, transformFromRotZ = Transform.fromRotX, Transform.fromRotY, Transform.fromRotZ
transformFrom3DRotation, transformFromPosition = Transform.from3DRotation, Transform.fromPosition


def transformInverse(transform: Transform, out: Transform | None = None) -> Transform | None:
    """Inverse of a transform; written to `out` if that is given."""
    require(transform, Transform, "transformInverse")
    return answer(transform.inverse(), out, "transformInverse")


def transformInvertInPlace(transform: Transform) -> None:
    """Replace a transform by its inverse."""
    transformInverse(transform, transform)


def transformPreMultiply(left: Transform, right: Transform) -> None:
    """Replace `right` by `left * right`."""
    require(left, Transform, "transformPreMultiply")
    require(right, Transform, "transformPreMultiply")
    fill(right, left * right, "transformPreMultiply")


transformDiff = asking("diff", (Transform,), Transform.diff.__doc__, "transformDiff")
transformDistanceSquared = asking(
    "distanceSquared", (Transform,), "Square of the distance between two origins, in m^2.", "transformDistanceSquared"
)
transformDistance = asking("distance", (Transform,), "Distance between two origins, in m.", "transformDistance")
normalizeTransform = asking("normalizeTransform", (Transform,), Transform.normalizeTransform.__doc__)


def transformToFloatVector(transform: Transform, out: list[float] | None = None) -> list[float] | None:
    """List the upper three rows, 12 numbers, or write them to `out`. `Transform.toVector` lists all 16."""
    require(transform, Transform, "transformToFloatVector")
    return Components.toVector(transform, out)


class Displacement:
    """A translation and a rotation. `P`: the translation, in m. `Q`: the rotation."""

    def __init__(self, P: Position3D | None = None, Q: Quaternion | None = None) -> None:
        """Copy the parts; one that is left out is the identity."""
        self.P = Position3D() if P is None else Position3D(P)
        self.Q = Quaternion() if Q is None else Quaternion(Q)

    def __mul__(self, other: Displacement) -> Displacement:
        """Chain two displacements."""
        if not isinstance(other, Displacement):
            return NotImplemented
        return Displacement(self.P + self.Q * other.P, self.Q * other.Q)

    def __imul__(self, other: Displacement) -> Displacement:
        """Chain another displacement to this one, in place."""
        product = self * other
        self.P, self.Q = product.P, product.Q
        return self

    def isNear(self, other: Displacement, epsilon: float = 0.0001) -> bool:
        """Tell whether translation and rotation differ by no more than `epsilon` in each number."""
        require(other, Displacement, "Displacement.isNear")
        return self.P.isNear(other.P, epsilon) and self.Q.isNear(other.Q, epsilon)

    def __repr__(self) -> str:
        return f"Displacement(P={self.P!r}, Q={self.Q!r})"


class TransformAndVelocity6D:
    """Where a frame is and how it moves. `T`: the frame. `V`: its velocity."""

    def __init__(self, T: Transform | None = None, V: Velocity6D | None = None) -> None:
        """Copy the parts; without them the frame is the identity, at rest."""
        self.T = Transform() if T is None else Transform(T)
        self.V = Velocity6D() if V is None else Velocity6D(V)

    def isNear(self, other: TransformAndVelocity6D, epsilon: float = 0.0001) -> bool:
        """Tell whether frame and velocity differ by no more than `epsilon` in each number."""
        require(other, TransformAndVelocity6D, "TransformAndVelocity6D.isNear")
        return self.T.isNear(other.T, epsilon) and self.V.isNear(other.V, epsilon)

    def __repr__(self) -> str:
        return f"TransformAndVelocity6D(T={self.T!r}, V={self.V!r})"
