"""The same vector or transform in turned axes.

Only the rotation of the given transform is used: these functions turn and never translate. Their `Transpose`
forms turn back. All of them write their result to the last argument.
"""

from __future__ import annotations

from typing import Callable, TypeVar

from almath import _matrix
from almath._components import as_number, fill, require
from almath.pose2d import Pose2D
from almath.positions import Position3D, Position6D, Velocity6D
from almath.transform import Transform

Turnable = TypeVar("Turnable", Position3D, Position6D, Velocity6D)


def _turning(kind: type[Turnable], what: str, back: bool = False) -> Callable[[Transform, Turnable, Turnable], None]:
    """A function that turns each triple of numbers of a vector, forth or back."""
    name = f"changeReference{'Transpose' if back else ''}{kind.__name__}"

    def turn(transform: Transform, vector: Turnable, out: Turnable) -> None:
        require(transform, Transform, name)
        require(vector, kind, name)
        require(out, kind, name)
        rows = _matrix.transposed(transform._rows()) if back else transform._rows()
        numbers = vector._values()
        triples = (tuple(numbers[start : start + 3]) for start in range(0, len(numbers), 3))
        out._assign([number for triple in triples for number in _matrix.applied(rows, triple)])

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
