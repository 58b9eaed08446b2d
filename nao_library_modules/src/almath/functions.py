"""Functions that ask a value of any suitable class for one of its properties."""

from __future__ import annotations

from typing import Union

from almath._components import Placed, answer, asking
from almath.errors import AlmathError
from almath.pose2d import Pose2D
from almath.positions import Position2D, Position3D, Position6D, Velocity3D, Velocity6D
from almath.quaternion import Quaternion
from almath.rotations import Rotation, Rotation3D
from almath.transform import Transform

Vector = Union[Position2D, Position3D]

_VECTORS = (Position2D, Position3D)
_PLACED = (Pose2D, Position2D, Position3D, Position6D)
_DIRECTED = (*_PLACED, Quaternion, Velocity3D, Velocity6D)
_NORMED = (*_DIRECTED, Rotation3D, Transform)


norm = asking("norm", _NORMED, "Length of a vector; of a pose or a transform, that of its translation.")
normalize = asking("normalize", _DIRECTED, "Divide a vector by its length; a pose keeps its heading.")
distance = asking("distance", _PLACED, Placed.distance.__doc__)
distanceSquared = asking("distanceSquared", _PLACED, Placed.distanceSquared.__doc__)
dotProduct = asking("dotProduct", _VECTORS, "Inner product of two vectors of one class.")
_cross_product = asking("crossProduct", _VECTORS, "Vector product of two vectors of one class.")
isUnitVector = asking("isUnitVector", (Position3D,), Position3D.isUnitVector.__doc__)
isOrthogonal = asking("isOrthogonal", (Position3D,), Position3D.isOrthogonal.__doc__)
transpose = asking("transpose", (Rotation,), Rotation.transpose.__doc__)
pinv = asking("inverse", (Pose2D, Transform), "Inverse of a pose or a transform.", "pinv")


def crossProduct(a: Vector, b: Vector, out: Position3D | None = None) -> float | Position3D | None:
    """Vector product of two vectors of one class; in space it is written to `out` if that is given.

    In the plane it is a number, positive if `b` lies to the left of `a`.
    """
    result = _cross_product(a, b)
    if isinstance(result, Position3D):
        return answer(result, out, "crossProduct")
    if out is not None:
        raise AlmathError(f"crossProduct in the plane returns a number and cannot fill {out!r}")
    return result


def determinant(matrix: Rotation | Transform | list[float]) -> float:
    """Determinant of a rotation, of a transform's rotation, or of a list of 9, 12 or 16 numbers."""
    if not isinstance(matrix, (Rotation, Transform)):
        matrix = Rotation(matrix)
    return matrix.determinant()
