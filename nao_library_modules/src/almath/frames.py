"""Values in other frames: turned axes, rotations about a given axis, and the way from one transform to another.

A Velocity6D held for one second is a screw motion; the exponential is where it leads, the logarithm the velocity that
leads there.
"""

from __future__ import annotations

import math
from typing import Callable, TypeVar

import numpy as np

from almath import _matrix
from almath._components import AlmathError, answer, as_number, fill, require
from almath.positions import Pose2D, Position3D, Position6D, Velocity6D
from almath.rotations import Rotation, Transform
from almath.tools import AXIS_MASK_X, AXIS_MASK_Y, AXIS_MASK_Z

# Changes of reference use only the rotation of the given transform: they turn and never translate. Their `Transpose`
# forms turn back. All of them write their result to the last argument.

Turnable = TypeVar("Turnable", Position3D, Position6D, Velocity6D)


def _turning(kind: type[Turnable], what: str, back: bool = False) -> Callable[[Transform, Turnable, Turnable], None]:
    """A function that turns each triple of numbers of a vector, forth or back."""
    name = f"changeReference{'Transpose' if back else ''}{kind.__name__}"

    def turn(transform: Transform, vector: Turnable, out: Turnable) -> None:
        require(transform, Transform, name)
        require(vector, kind, name)
        require(out, kind, name)
        rows = transform._rows() if back else transform._rows().T
        out._assign((np.reshape(vector._values(), (-1, 3)) @ rows).ravel())

    turn.__name__ = turn.__qualname__ = name
    turn.__doc__ = f"Turn {what}{' back' if back else ''} by the rotation of `transform`; the result goes to `out`."
    return turn


changeReferenceVelocity6D = _turning(Velocity6D, "a velocity")
changeReferenceTransposeVelocity6D = _turning(Velocity6D, "a velocity", back=True)
changeReferencePosition6D = _turning(Position6D, "both triples of a small displacement")
changeReferenceTransposePosition6D = _turning(Position6D, "both triples of a small displacement", back=True)
changeReferencePosition3D = _turning(Position3D, "a vector")
changeReferenceTransposePosition3D = _turning(Position3D, "a vector", back=True)


def changeReferencePosition3DInPlace(transform: Transform, point: Position3D) -> None:
    """Turn a vector by the rotation of `transform`, in place."""
    changeReferencePosition3D(transform, point, point)


def changeReferenceTransposePosition3DInPlace(transform: Transform, point: Position3D) -> None:
    """Turn a vector back by the rotation of `transform`, in place."""
    changeReferenceTransposePosition3D(transform, point, point)


def changeReferenceTransform(transform: Transform, other: Transform, out: Transform) -> None:
    """Turn another transform, its origin included, by the rotation of `transform`."""
    for argument in (transform, other, out):
        require(argument, Transform, "changeReferenceTransform")
    turn = Transform._from_rows(transform._rows())
    fill(out, turn * other, "changeReferenceTransform")


def changeReferenceTransposeTransform(transform: Transform, other: Transform, out: Transform) -> None:
    """Turn another transform, its origin included, back by the rotation of `transform`."""
    require(transform, Transform, "changeReferenceTransposeTransform")
    changeReferenceTransform(transform.inverse(), other, out)


def changeReferencePose2D(theta: float, pose: Pose2D, out: Pose2D) -> None:
    """Turn the point of a pose by `theta` rad about the origin; its heading stays."""
    require(pose, Pose2D, "changeReferencePose2D")
    require(out, Pose2D, "changeReferencePose2D")
    turned = Pose2D(0.0, 0.0, as_number(theta, "changeReferencePose2D theta")) * pose
    out._assign((turned.x, turned.y, pose.theta))


def changeReferencePose2DInPlace(theta: float, pose: Pose2D) -> None:
    """Turn the point of a pose by `theta` rad about the origin, in place; its heading stays."""
    changeReferencePose2D(theta, pose, pose)


_AXES = {AXIS_MASK_X: 0, AXIS_MASK_Y: 1, AXIS_MASK_Z: 2}

# Components of a unit vector below this do not decide where the other two axes of a frame go.
_NEGLIGIBLE = 0.0001


def axisRotationProjection(axis: Position3D, rotated: Rotation | Transform) -> Rotation | Transform:
    """Rotation about `axis` that is nearest to a given one; the origin of a transform stays.

    `axis`: of any length but zero. `rotated`: the rotation or transform to project.
    """
    require(axis, Position3D, "axisRotationProjection")
    if not isinstance(rotated, (Rotation, Transform)):
        raise AlmathError(f"axisRotationProjection takes a Rotation or a Transform, got {rotated!r}")
    return rotated._with_rows(_projected(np.array(axis.normalize()._values()), rotated._rows()))


def axisRotationProjectionInPlace(axis: Position3D, rotated: Rotation | Transform) -> None:
    """Replace a rotation by the nearest one about `axis`; the origin of a transform stays."""
    fill(rotated, axisRotationProjection(axis, rotated), "axisRotationProjectionInPlace")


def _projected(axis: np.ndarray, rows: np.ndarray) -> np.ndarray:
    # Nearest means the largest trace of A(angle)^T R, which is a + b cos(angle) + c sin(angle).
    return _matrix.about_axis(axis, math.atan2(axis @ _matrix.axial(rows), np.trace(rows) - axis @ rows @ axis))


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
    columns = [column._values() for column in (first, third.crossProduct(first), third)]
    placed = Transform() if out is None else out
    require(placed, Transform, "orthogonalSpace")
    return answer(placed._with_rows(np.column_stack(columns)), out, "orthogonalSpace")


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
    if len(turn) != 2 or turn[0] not in _AXES:
        raise AlmathError(
            "transformFromRotVec takes a Position3D, or AXIS_MASK_X (1), AXIS_MASK_Y (2) or AXIS_MASK_Z (4) "
            f"and an angle, or all three, got {arguments!r}"
        )
    angle = as_number(turn[1], "transformFromRotVec angle")
    return Transform._from_parts(_matrix.about(_AXES[turn[0]], angle), point._values())


# Below this angle, in rad, the closed formulas divide rounding errors by its square; their series take over.
_SMALL_ANGLE = 0.0001


def velocityExponential(velocity: Velocity6D) -> Transform:
    """Transform that a body velocity, in m/s and rad/s, leads to within one second."""
    require(velocity, Velocity6D, "velocityExponential")
    linear, angular = np.reshape(velocity._values(), (2, 3))
    angle = math.hypot(*angular)
    if angle < _SMALL_ANGLE:
        rows = _matrix.from_quaternion(1.0, *(0.5 * angular))
        across, along = 0.5, 1.0 / 6.0
    else:
        rows = _matrix.about_axis(angular / angle, angle)
        across = (1.0 - math.cos(angle)) / angle**2
        along = (angle - math.sin(angle)) / angle**3
    return Transform._from_parts(rows, _bent(linear, angular, across, along))


def transformLogarithm(transform: Transform) -> Velocity6D:
    """Body velocity, in m/s and rad/s, that leads from the identity to `transform` within one second.

    The rotation is the shorter way round, at most pi.
    """
    require(transform, Transform, "transformLogarithm")
    w, *vector = _matrix.to_quaternion(transform._rows())
    sine = math.hypot(*vector)
    angle = 2.0 * math.atan2(sine, w)
    if angle < _SMALL_ANGLE:
        angular = 2.0 * np.array(vector)
        along = 1.0 / 12.0
    else:
        angular = np.array(vector) * (angle / sine)
        along = (1.0 - 0.5 * angle * w / sine) / angle**2
    return Velocity6D([*_bent(np.array(transform._point()), angular, -0.5, along), *angular])


def _bent(v: np.ndarray, angular: np.ndarray, across: float, along: float) -> np.ndarray:
    """Sum v + across (angular x v) + along (angular x (angular x v)).

    The straight and the screwed way to a point differ by such a sum, in both directions.
    """
    turning = _matrix.skew(angular)
    once = turning @ v
    return v + across * once + along * (turning @ once)


def transformMean(start: Transform, end: Transform, share: float = 0.5) -> Transform:
    """Transform on the screw motion from one to another.

    `start`: where the motion begins. `share`: how much of it is done, in [0, 1].
    """
    require(start, Transform, "transformMean")
    require(end, Transform, "transformMean")
    if not 0.0 <= as_number(share, "transformMean share") <= 1.0:
        raise AlmathError(f"transformMean takes a share in [0, 1], got {share}")
    return start * velocityExponential(transformLogarithm(start.diff(end)) * share)


def position6DFromTransformDiff(current: Transform, target: Transform) -> Position6D:
    """Difference of two transforms in the frame in which both are given, as a controller takes it.

    `current`: where the body is. `target`: where it should be. Returns the translation in m, and the axis of the
    rotation times the sine of its angle.
    """
    require(current, Transform, "position6DFromTransformDiff")
    require(target, Transform, "position6DFromTransformDiff")
    moved = np.subtract(target._point(), current._point())
    return Position6D([*moved, *(0.5 * _matrix.axial(target._rows() @ current._rows().T))])
