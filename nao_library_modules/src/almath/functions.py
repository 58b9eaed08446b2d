"""Functions that ask a value of any suitable class for one of its properties."""

from __future__ import annotations

from typing import Union

from almath._components import answer
from almath.errors import AlmathError
from almath.pose2d import Pose2D
from almath.positions import Position2D, Position3D, Position6D
from almath.quaternion import Quaternion
from almath.rotations import Rotation, Rotation3D
from almath.transform import Transform
from almath.velocities import Velocity3D, Velocity6D

Vector = Union[Position2D, Position3D]
Placed = Union[Pose2D, Position2D, Position3D, Position6D]
Directed = Union[Placed, Quaternion, Velocity3D, Velocity6D]
Normed = Union[Directed, Rotation3D, Transform]

_VECTORS = (Position2D, Position3D)
_PLACED = (Pose2D, Position2D, Position3D, Position6D)
_DIRECTED = (*_PLACED, Quaternion, Velocity3D, Velocity6D)
_NORMED = (*_DIRECTED, Rotation3D, Transform)


def _require_one_of(value: object, kinds: tuple[type, ...], where: str) -> None:
    if not isinstance(value, kinds):
        raise AlmathError(f"{where} takes one of {', '.join(kind.__name__ for kind in kinds)}, got {value!r}")


def norm(value: Normed) -> float:
    """Length of a vector; of a pose or a transform, that of its translation."""
    _require_one_of(value, _NORMED, "norm")
    return value.norm()


def normalize(value: Directed) -> Directed:
    """Divide a vector by its length; a pose keeps its heading."""
    _require_one_of(value, _DIRECTED, "normalize")
    return value.normalize()


def distance(a: Placed, b: Placed) -> float:
    """Distance between two points of one class, in m; angles do not count."""
    _require_one_of(a, _PLACED, "distance")
    return a.distance(b)


def distanceSquared(a: Placed, b: Placed) -> float:
    """Square of the distance between two points of one class, in m^2; angles do not count."""
    _require_one_of(a, _PLACED, "distanceSquared")
    return a.distanceSquared(b)


def dotProduct(a: Vector, b: Vector) -> float:
    """Inner product of two vectors of one class."""
    _require_one_of(a, _VECTORS, "dotProduct")
    return a.dotProduct(b)


def crossProduct(a: Vector, b: Vector, out: Position3D | None = None) -> float | Position3D | None:
    """Vector product of two vectors of one class.

    Args:
        a: First vector.
        b: Second vector.
        out: For vectors in space, a Position3D to overwrite instead of returning a new one.

    Returns:
        In the plane a number, positive if `b` lies to the left of `a`.
    """
    _require_one_of(a, _VECTORS, "crossProduct")
    result = a.crossProduct(b)
    if isinstance(result, Position3D):
        return answer(result, out, "crossProduct")
    if out is not None:
        raise AlmathError(f"crossProduct in the plane returns a number and cannot fill {out!r}")
    return result


def isUnitVector(vector: Position3D, epsilon: float = 0.0001) -> bool:
    """Tell whether the length is 1, within `epsilon`."""
    _require_one_of(vector, (Position3D,), "isUnitVector")
    return vector.isUnitVector(epsilon)


def isOrthogonal(a: Position3D, b: Position3D, epsilon: float = 0.0001) -> bool:
    """Tell whether the inner product is 0, within `epsilon`."""
    _require_one_of(a, (Position3D,), "isOrthogonal")
    return a.isOrthogonal(b, epsilon)


def transpose(rotation: Rotation) -> Rotation:
    """Swap rows and columns: the inverse of a rotation."""
    _require_one_of(rotation, (Rotation,), "transpose")
    return rotation.transpose()


def determinant(matrix: Rotation | Transform | list[float]) -> float:
    """Determinant of a rotation, of a transform's rotation, or of a list of 9, 12 or 16 numbers."""
    if not isinstance(matrix, (Rotation, Transform)):
        matrix = Rotation(matrix)
    return matrix.determinant()


def pinv(value: Pose2D | Transform) -> Pose2D | Transform:
    """Inverse of a pose or a transform."""
    _require_one_of(value, (Pose2D, Transform), "pinv")
    return value.inverse()
