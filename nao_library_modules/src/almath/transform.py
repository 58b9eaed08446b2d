"""Homogeneous transforms: a rotation and a translation."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real

from almath import _matrix
from almath._components import Components, Placed, Turning, answer, as_number, as_numbers, asking, fill, require
from almath.errors import AlmathError
from almath.positions import Position2D, Position3D

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
            return cls._from_parts(_matrix.IDENTITY, position)._values()
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
    def _from_parts(cls, rows: _matrix.Matrix, position: Iterable[float]) -> Transform:
        return cls._make(number for row, offset in zip(rows, position) for number in (*row, offset))

    @classmethod
    def _from_rows(cls, rows: _matrix.Matrix) -> Transform:
        return cls._from_parts(rows, (0.0, 0.0, 0.0))

    def _with_rows(self, rows: _matrix.Matrix) -> Transform:
        return self._from_parts(rows, self._point())

    def _point(self) -> _matrix.Triple:
        return (self.r1_c4, self.r2_c4, self.r3_c4)

    def _placed(self, point: _matrix.Triple) -> _matrix.Triple:
        return tuple(a + b for a, b in zip(_matrix.applied(self._rows(), point), self._point()))

    def __mul__(self, other: Transform | Position3D | Position2D) -> Transform | Position3D:
        """Chain two transforms, or place a point; one of the plane is taken at z = 0."""
        if isinstance(other, Transform):
            rows = _matrix.product(self._rows(), other._rows())
            return self._from_parts(rows, self._placed(other._point()))
        if isinstance(other, Position3D):
            return Position3D(*self._placed((other.x, other.y, other.z)))
        if isinstance(other, Position2D):
            return Position3D(*self._placed((other.x, other.y, 0.0)))
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
        return math.sqrt(_matrix.dot(self._point(), self._point()))

    def inverse(self) -> Transform:
        """Transform that undoes this one."""
        rows = _matrix.transposed(self._rows())
        return self._from_parts(rows, _matrix.scaled(_matrix.applied(rows, self._point()), -1.0))

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
