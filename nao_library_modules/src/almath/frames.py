"""The same vector or transform in turned axes.

Only the rotation of the given transform is used: these functions turn and never translate. Their `Transpose`
forms turn back. All of them write their result to the last argument.
"""

from __future__ import annotations

from typing import Union

from almath import _matrix
from almath._components import as_number, fill, require
from almath.pose2d import Pose2D
from almath.positions import Position3D, Position6D, Velocity6D
from almath.transform import Transform

Turnable = Union[Position3D, Position6D, Velocity6D]


def _turn(kind: type, transform: Transform, vector: Turnable, out: Turnable, where: str, back: bool = False) -> None:
    """Turn each triple of numbers of a vector, forth or back, and write the result to `out`."""
    require(transform, Transform, where)
    require(vector, kind, where)
    require(out, kind, where)
    rows = _matrix.transposed(transform._rows()) if back else transform._rows()
    numbers = vector._values()
    triples = (tuple(numbers[start : start + 3]) for start in range(0, len(numbers), 3))
    out._assign([number for triple in triples for number in _matrix.applied(rows, triple)])


def changeReferenceVelocity6D(transform: Transform, velocity: Velocity6D, out: Velocity6D) -> None:
    """Turn a velocity by the rotation of `transform`."""
    _turn(Velocity6D, transform, velocity, out, "changeReferenceVelocity6D")


def changeReferenceTransposeVelocity6D(transform: Transform, velocity: Velocity6D, out: Velocity6D) -> None:
    """Turn a velocity back by the rotation of `transform`."""
    _turn(Velocity6D, transform, velocity, out, "changeReferenceTransposeVelocity6D", back=True)


def changeReferencePosition6D(transform: Transform, position: Position6D, out: Position6D) -> None:
    """Turn both triples of a small displacement by the rotation of `transform`."""
    _turn(Position6D, transform, position, out, "changeReferencePosition6D")


def changeReferenceTransposePosition6D(transform: Transform, position: Position6D, out: Position6D) -> None:
    """Turn both triples of a small displacement back by the rotation of `transform`."""
    _turn(Position6D, transform, position, out, "changeReferenceTransposePosition6D", back=True)


def changeReferencePosition3D(transform: Transform, point: Position3D, out: Position3D) -> None:
    """Turn a vector by the rotation of `transform`."""
    _turn(Position3D, transform, point, out, "changeReferencePosition3D")


def changeReferenceTransposePosition3D(transform: Transform, point: Position3D, out: Position3D) -> None:
    """Turn a vector back by the rotation of `transform`."""
    _turn(Position3D, transform, point, out, "changeReferenceTransposePosition3D", back=True)


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
    turn = Transform._from_parts(transform._rows(), (0.0, 0.0, 0.0))
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
