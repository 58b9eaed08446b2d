"""Rotations about a given axis."""

from __future__ import annotations

import math

from almath import _matrix
from almath._components import answer, as_number, fill, in_place, require
from almath.constants import AXIS_MASK_X, AXIS_MASK_Y, AXIS_MASK_Z
from almath.errors import AlmathError
from almath.positions import Position3D
from almath.rotations import Rotation
from almath.transform import Transform

_ABOUT = {AXIS_MASK_X: _matrix.about_x, AXIS_MASK_Y: _matrix.about_y, AXIS_MASK_Z: _matrix.about_z}

# Components of a unit vector below this do not decide where the other two axes of a frame go.
_NEGLIGIBLE = 0.0001


def axisRotationProjection(axis: Position3D, rotated: Rotation | Transform) -> Rotation | Transform:
    """Rotation about `axis` that is nearest to a given one; the origin of a transform stays.

    `axis`: of any length but zero. `rotated`: the rotation or transform to project.
    """
    require(axis, Position3D, "axisRotationProjection")
    if not isinstance(rotated, (Rotation, Transform)):
        raise AlmathError(f"axisRotationProjection takes a Rotation or a Transform, got {rotated!r}")
    return rotated._with_rows(_projected(tuple(axis.normalize()._values()), rotated._rows()))


def axisRotationProjectionInPlace(axis: Position3D, rotated: Rotation | Transform) -> None:
    """Replace a rotation by the nearest one about `axis`; the origin of a transform stays."""
    fill(rotated, axisRotationProjection(axis, rotated), "axisRotationProjectionInPlace")


def _projected(axis: _matrix.Triple, rows: _matrix.Matrix) -> _matrix.Matrix:
    # Nearest means the largest trace of A(angle)^T R, which is a + b cos(angle) + c sin(angle).
    turning = (rows[2][1] - rows[1][2], rows[0][2] - rows[2][0], rows[1][0] - rows[0][1])
    cosine = rows[0][0] + rows[1][1] + rows[2][2] - _matrix.dot(axis, _matrix.applied(rows, axis))
    return _matrix.about_axis(axis, math.atan2(_matrix.dot(axis, turning), cosine))


def orthogonalSpace(axis: Position3D, out: Transform | None = None) -> Transform | None:
    """Right-handed frame whose third axis has a given direction.

    `axis`: of any length but zero. `out`: a transform whose rotation to overwrite, instead of returning a new one; its
    origin stays.
    """
    require(axis, Position3D, "orthogonalSpace")
    third = axis.normalize()
    if abs(third.x) > _NEGLIGIBLE:
        first = Position3D(-third.y, third.x, 0.0)
    elif abs(third.y) > _NEGLIGIBLE:
        first = Position3D(0.0, -third.z, third.y)
    else:
        first = Position3D(third.z, 0.0, 0.0)
    first = first.normalize()
    columns = tuple(tuple(column._values()) for column in (first, third.crossProduct(first), third))
    placed = Transform() if out is None else out
    require(placed, Transform, "orthogonalSpace")
    return answer(placed._with_rows(_matrix.transposed(columns)), out, "orthogonalSpace")


def transformFromRotVec(*arguments: int | float | Position3D) -> Transform:
    """Rotation about one of the coordinate axes, a translation, or both.

    Args:
        *arguments: A Position3D; or AXIS_MASK_X, AXIS_MASK_Y or AXIS_MASK_Z and an angle in rad; or all
            three.
    """
    point = Position3D()
    turn = arguments
    if arguments and isinstance(arguments[-1], Position3D):
        *turn, point = arguments
    if not turn and arguments:
        return Transform(point.x, point.y, point.z)
    if len(turn) != 2 or turn[0] not in _ABOUT:
        raise AlmathError(
            "transformFromRotVec takes a Position3D, or AXIS_MASK_X (1), AXIS_MASK_Y (2) or AXIS_MASK_Z (4) "
            f"and an angle, or all three, got {arguments!r}"
        )
    return Transform._from_parts(_ABOUT[turn[0]](as_number(turn[1], "transformFromRotVec angle")), point._values())


transformFromRotVecInPlace = in_place(transformFromRotVec)
