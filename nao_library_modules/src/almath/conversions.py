"""From one kind of position or rotation to another, and functions that take values of many classes.

Where the SDK has a second form that fills an object, it is here under its name too: a function with `InPlace`
at the end, or an optional last argument.
"""

from __future__ import annotations

from typing import Union

from almath import _matrix
from almath._components import AlmathError, Placed, answer, as_number, asking, fill, require
from almath.positions import Pose2D, Position2D, Position3D, Position6D, Velocity3D, Velocity6D
from almath.rotations import Displacement, Quaternion, Rotation, Rotation3D, Transform

# --- to points and poses


def position2DFromPose2D(pose: Pose2D) -> Position2D:
    """Point of a pose."""
    require(pose, Pose2D, "position2DFromPose2D")
    return Position2D(pose.x, pose.y)


def position2DFromTransform(transform: Transform) -> Position2D:
    """Origin of a transform, seen from above."""
    require(transform, Transform, "position2DFromTransform")
    return Position2D(transform.r1_c4, transform.r2_c4)


def position3DFromPosition6D(position: Position6D) -> Position3D:
    """Point of a position."""
    require(position, Position6D, "position3DFromPosition6D")
    return Position3D(position.x, position.y, position.z)


def position3DFromTransform(transform: Transform) -> Position3D:
    """Origin of a transform."""
    require(transform, Transform, "position3DFromTransform")
    return Position3D(*transform._point())


def position6DFromPose2D(pose: Pose2D) -> Position6D:
    """Pose on the floor as a position in space."""
    require(pose, Pose2D, "position6DFromPose2D")
    return Position6D(pose.x, pose.y, 0.0, 0.0, 0.0, pose.theta)


def position6DFromPosition3D(point: Position3D) -> Position6D:
    """Point with angles of zero."""
    require(point, Position3D, "position6DFromPosition3D")
    return Position6D(point.x, point.y, point.z, 0.0, 0.0, 0.0)


def position6DFromVelocity6D(velocity: Velocity6D) -> Position6D:
    """Way made in one second: the same six numbers."""
    require(velocity, Velocity6D, "position6DFromVelocity6D")
    return Position6D(velocity._values())


def position6DFromTransform(transform: Transform) -> Position6D:
    """Origin and angles of a transform, R = Rz(wz) Ry(wy) Rx(wx)."""
    require(transform, Transform, "position6DFromTransform")
    return Position6D(*transform._point(), *_matrix.to_angles(transform._rows()))


def pose2DFromPosition2D(point: Position2D, theta: float = 0.0) -> Pose2D:
    """Pose at a point with a heading in rad."""
    require(point, Position2D, "pose2DFromPosition2D")
    return Pose2D(point.x, point.y, theta)


def pose2DFromPosition6D(position: Position6D) -> Pose2D:
    """Position seen from above: x, y and wz."""
    require(position, Position6D, "pose2DFromPosition6D")
    return Pose2D(position.x, position.y, position.wz)


def pose2DFromTransform(transform: Transform) -> Pose2D:
    """Transform seen from above: x, y and yaw."""
    require(transform, Transform, "pose2DFromTransform")
    return Pose2D(transform.r1_c4, transform.r2_c4, _matrix.to_angles(transform._rows())[2])


# --- to rotations


def rotationFromTransform(transform: Transform) -> Rotation:
    """Rotation of a transform."""
    require(transform, Transform, "rotationFromTransform")
    return Rotation._from_rows(transform._rows())


def rotationFromQuaternion(*arguments: Quaternion | Rotation | float) -> Rotation | None:
    """Rotation of a quaternion of any length but zero.

    Args:
        *arguments: A Quaternion, alone or with a Rotation to overwrite, or its numbers w, x, y, z.
    """
    if len(arguments) == 4:
        return Rotation.fromQuaternion(*(as_number(a, "rotationFromQuaternion") for a in arguments))
    if len(arguments) not in (1, 2):
        raise AlmathError(f"rotationFromQuaternion takes a Quaternion or four numbers, got {arguments!r}")
    require(arguments[0], Quaternion, "rotationFromQuaternion")
    rotation = Rotation.fromQuaternion(*arguments[0]._values())
    return answer(rotation, arguments[1] if len(arguments) == 2 else None, "rotationFromQuaternion")


def rotation3DFromRotation(rotation: Rotation) -> Rotation3D:
    """Angles of a rotation, R = Rz(wz) Ry(wy) Rx(wx)."""
    require(rotation, Rotation, "rotation3DFromRotation")
    return Rotation3D(*_matrix.to_angles(rotation._rows()))


def rotation3DFromTransform(transform: Transform) -> Rotation3D:
    """Angles of a transform, R = Rz(wz) Ry(wy) Rx(wx)."""
    return rotation3DFromRotation(rotationFromTransform(transform))


def rotation3DFromQuaternion(quaternion: Quaternion, out: Rotation3D | None = None) -> Rotation3D | None:
    """Angles of a quaternion, R = Rz(wz) Ry(wy) Rx(wx); written to `out` if that is given."""
    return answer(rotation3DFromRotation(rotationFromQuaternion(quaternion)), out, "rotation3DFromQuaternion")


def quaternionFromRotation3D(angles: Rotation3D, out: Quaternion | None = None) -> Quaternion | None:
    """Quaternion of Rz(wz) Ry(wy) Rx(wx); written to `out` if that is given."""
    require(angles, Rotation3D, "quaternionFromRotation3D")
    about_x = Quaternion.fromAngleAndAxisRotation(angles.wx, 1.0, 0.0, 0.0)
    about_y = Quaternion.fromAngleAndAxisRotation(angles.wy, 0.0, 1.0, 0.0)
    about_z = Quaternion.fromAngleAndAxisRotation(angles.wz, 0.0, 0.0, 1.0)
    return answer(about_z * about_y * about_x, out, "quaternionFromRotation3D")


def quaternionFromTransform(transform: Transform) -> Quaternion:
    """Unit quaternion of a transform's rotation, with w >= 0."""
    require(transform, Transform, "quaternionFromTransform")
    return Quaternion(*_matrix.to_quaternion(transform._rows()))


def quaternionPosition3DFromPosition6D(position: Position6D, out_quaternion: Quaternion, out_point: Position3D) -> None:
    """Split a position into a quaternion and a point, written to the last two arguments."""
    point = position3DFromPosition6D(position)
    fill(out_point, point, "quaternionPosition3DFromPosition6D")
    quaternion = quaternionFromRotation3D(Rotation3D(position.wx, position.wy, position.wz))
    fill(out_quaternion, quaternion, "quaternionPosition3DFromPosition6D")


# --- to transforms


def transformFromPose2D(pose: Pose2D) -> Transform:
    """Transform of a pose on the floor."""
    require(pose, Pose2D, "transformFromPose2D")
    return Transform.fromPosition(pose.x, pose.y, 0.0, 0.0, 0.0, pose.theta)


def transformFromPosition3D(point: Position3D) -> Transform:
    """Translation to a point."""
    require(point, Position3D, "transformFromPosition3D")
    return Transform(point.x, point.y, point.z)


def transformFromPosition3DInPlace(point: Position3D, out: Transform) -> None:
    """Move the origin of `out` to a point; its rotation stays."""
    require(point, Position3D, "transformFromPosition3DInPlace")
    require(out, Transform, "transformFromPosition3DInPlace")
    out.r1_c4, out.r2_c4, out.r3_c4 = point._values()


def transformFromPosition6D(position: Position6D) -> Transform:
    """Transform of a point and three angles."""
    require(position, Position6D, "transformFromPosition6D")
    return Transform.fromPosition(*position._values())


def transformFromRotation(rotation: Rotation) -> Transform:
    """Transform of a rotation, without translation."""
    require(rotation, Rotation, "transformFromRotation")
    return Transform._from_rows(rotation._rows())


def transformFromRotationInPlace(rotation: Rotation, out: Transform) -> None:
    """Give `out` a rotation; its origin stays."""
    require(rotation, Rotation, "transformFromRotationInPlace")
    require(out, Transform, "transformFromRotationInPlace")
    fill(out, out._with_rows(rotation._rows()), "transformFromRotationInPlace")


def transformFromRotation3D(angles: Rotation3D) -> Transform:
    """Transform of three angles, without translation."""
    require(angles, Rotation3D, "transformFromRotation3D")
    return Transform.from3DRotation(*angles._values())


def transformFromRotationPosition3D(rotation: Rotation, *point: Position3D | float) -> Transform:
    """Transform of a rotation and a point, given as a Position3D or as three numbers."""
    require(rotation, Rotation, "transformFromRotationPosition3D")
    return Transform._from_parts(rotation._rows(), Position3D(*point)._values())


def transformFromQuaternion(quaternion: Quaternion) -> Transform:
    """Transform of a quaternion, without translation."""
    return transformFromRotation(rotationFromQuaternion(quaternion))


def transformFromDisplacement(displacement: Displacement) -> Transform:
    """Transform of a point and a quaternion."""
    require(displacement, Displacement, "transformFromDisplacement")
    return transformFromRotationPosition3D(rotationFromQuaternion(displacement.Q), displacement.P)


def displacementFromTransform(transform: Transform) -> Displacement:
    """Point and quaternion of a transform."""
    return Displacement(position3DFromTransform(transform), quaternionFromTransform(transform))


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
