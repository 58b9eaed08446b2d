"""Rotations, quaternions, transforms, displacements and screws: group laws, round trips, and values known by hand."""

from __future__ import annotations

import math

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import almath
from almath import AlmathError, Position3D, Position6D, Quaternion, Rotation, Transform, Velocity6D

few = settings(max_examples=20)
metres = st.floats(-2.0, 2.0)
turns = st.floats(-3.1, 3.1)
pitches = st.floats(-1.5, 1.5)  # those that a transform gives back
points = st.builds(Position3D, metres, metres, metres)
rotations = st.builds(Rotation.from3DRotation, turns, turns, turns)
transforms = st.builds(Transform.fromPosition, metres, metres, metres, turns, turns, turns)
positions = st.builds(Position6D, metres, metres, metres, turns, pitches, turns)
axes = points.filter(lambda axis: axis.norm() > 0.1)
quaternions = st.builds(lambda angle, axis: Quaternion.fromAngleAndAxisRotation(angle, *axis.toVector()), turns, axes)
X, Y, Z = Position3D(1, 0, 0), Position3D(0, 1, 0), Position3D(0, 0, 1)
POSITION = Position6D(0.1, -0.2, 0.3, 0.4, -0.5, 0.6)


def matrix_of(value):
    numbers = numpy.array(value.toVector())
    return numbers.reshape(round(math.sqrt(len(numbers))), -1)


def refused(told, function, *arguments):
    with pytest.raises(AlmathError, match=told):
        function(*arguments)


# Rotations


@pytest.mark.parametrize(
    "rotation, turned",
    [
        (Rotation.fromRotX(math.pi / 2), [X, Z, -Y]),
        (Rotation.fromRotY(math.pi / 2), [-Z, Y, X]),
        (Rotation.fromRotZ(math.pi / 2), [Y, -X, Z]),
    ],
)
def test_a_quarter_turn_moves_the_axes_by_the_right_hand_rule(rotation, turned):
    for axis, image in zip((X, Y, Z), turned):
        assert (rotation * axis).isNear(image, 1e-12)


@few
@given(turns, turns, turns)
def test_three_angles_turn_about_x_first_and_z_last(wx, wy, wz):
    chained = almath.rotationFromRotZ(wz) * almath.rotationFromRotY(wy) * almath.rotationFromRotX(wx)
    rotation = Rotation.from3DRotation(wx, wy, wz)
    assert rotation.isNear(chained, 1e-12)
    assert almath.rotationFrom3DRotation(wx, wy, wz) == rotation
    angles = almath.rotation3DFromRotation(rotation)
    assert abs(angles.wy) <= math.pi / 2
    assert Rotation.from3DRotation(*angles.toVector()).isNear(rotation, 1e-9)


@pytest.mark.parametrize("wy", [math.pi / 2, -math.pi / 2])
@pytest.mark.parametrize("wx, wz", [(0.4, 0.0), (1.2, 0.5)])
def test_angles_are_found_where_the_pitch_is_a_right_angle(wx, wy, wz):
    rotation = Rotation.from3DRotation(wx, wy, wz)
    assert Rotation.from3DRotation(*almath.rotation3DFromRotation(rotation).toVector()).isNear(rotation, 1e-9)


@few
@given(rotations, rotations, points)
def test_products_and_turned_vectors_agree_with_numpy(a, b, point):
    assert matrix_of(a * b) == pytest.approx(matrix_of(a) @ matrix_of(b))
    assert matrix_of(a.transpose()) == pytest.approx(matrix_of(a).T)
    assert almath.transpose(a) == a.transpose()
    assert (a * a.transpose()).isNear(Rotation(), 1e-12)
    assert a.determinant() == pytest.approx(1.0)
    turned = matrix_of(a) @ point.toVector()
    assert (a * point).toVector() == pytest.approx(turned)
    assert (a * almath.Velocity3D(point.toVector())).toVector() == pytest.approx(turned)
    assert almath.applyRotation(a, *point.toVector()) == pytest.approx(turned)
    product = Rotation(a)
    product *= b
    assert product == a * b and product.isRotation(1e-9)


@few
@given(axes, st.floats(-3.0, 3.0))
def test_rotation_about_an_axis_leaves_the_axis_and_turns_by_the_angle(axis, angle):
    axis = axis.normalize()
    rotation = almath.rotationFromAngleDirection(angle, axis)
    assert rotation.isRotation(1e-9)
    assert (rotation * axis).isNear(axis, 1e-9)
    assert sum(matrix_of(rotation).diagonal()) == pytest.approx(1.0 + 2.0 * math.cos(angle))
    assert almath.rotationFromAngleDirection(angle, axis.x, axis.y, axis.z) == rotation
    assert almath.axisRotationProjection(axis * 5.0, rotation).isNear(rotation, 1e-9)


@few
@given(rotations, st.lists(st.floats(-0.01, 0.01), min_size=9, max_size=9))
def test_normalizing_a_disturbed_rotation_keeps_the_third_column_and_is_idempotent(rotation, noise):
    disturbed = Rotation(matrix_of(rotation).ravel() + noise)
    third = matrix_of(disturbed)[:, 2]
    almath.normalizeRotation(disturbed)
    assert disturbed.isRotation(1e-9) and disturbed.isNear(rotation, 0.1)
    assert matrix_of(disturbed)[:, 2] == pytest.approx(third / numpy.linalg.norm(third))
    again = Rotation(disturbed)
    again.normalizeRotation()
    assert again.isNear(disturbed, 1e-12)


def test_a_matrix_without_a_plane_is_no_rotation():
    refused("do not span a plane", Rotation([0, 1, 1, 0, 1, 1, 0, 1, 1]).normalizeRotation)


def test_axes_become_columns():
    rotation = Rotation.from3DRotation(0.5, -0.3, 1.9)
    x, y, z = (Position3D(column) for column in matrix_of(rotation).T)
    assert almath.rotationFromAxesXYZ(x, y, z).isNear(rotation, 1e-12)
    assert almath.rotationFromAxesXY(x, y).isNear(rotation, 1e-12)
    assert almath.rotationFromAxesXZ(x, z).isNear(rotation, 1e-12)
    assert almath.rotationFromAxesYZ(y, z).isNear(rotation, 1e-12)
    refused("right-handed", almath.rotationFromAxesXYZ, y, x, z)
    refused("right angles", almath.rotationFromAxesXY, x, x)


def test_named_turns_have_no_rounding_and_mirrors_and_stretched_matrices_are_no_rotations():
    assert Rotation.fromRotXPi() == Rotation([1, 0, 0, 0, -1, 0, 0, 0, -1])
    assert Rotation.fromRotYPi() == Rotation([-1, 0, 0, 0, 1, 0, 0, 0, -1])
    assert Rotation.fromRotZPi() == Rotation([-1, 0, 0, 0, -1, 0, 0, 0, 1])
    assert Rotation.fromRotZHalfPi() == Rotation([0, -1, 0, 1, 0, 0, 0, 0, 1])
    assert not Rotation([1, 0, 0, 0, 1, 0, 0, 0, -1]).isRotation()
    assert not Rotation([1.001, 0, 0, 0, 1, 0, 0, 0, 1]).isRotation()


# Rotations about a given axis


def test_projection_of_transforms_keeps_the_origin_and_works_in_place():
    assert almath.axisRotationProjection(Z, almath.transformFromRotX(0.2)).isNear(Transform(), 1e-12)
    turned = Rotation.fromRotZ(0.5) * Rotation.fromRotX(0.2)
    assert almath.axisRotationProjection(Z, turned).isNear(Rotation.fromRotZ(0.5), 1e-12)
    transform = Transform.fromPosition(1.0, 2.0, 3.0, 0.2, 0.3, 0.4)
    projected = almath.axisRotationProjection(Y, transform)
    assert almath.position3DFromTransform(projected) == Position3D(1.0, 2.0, 3.0)
    almath.axisRotationProjectionInPlace(Y, transform)
    assert transform == projected
    refused("no direction", almath.axisRotationProjection, Position3D(), Rotation())


@pytest.mark.parametrize("axis", [(2, 0, 0), (0, -3, 0), (0, 0, -1), (1, 2, -3)])
def test_orthogonal_space_is_a_rotation_with_the_axis_in_its_third_column(axis):
    frame = almath.orthogonalSpace(Position3D(axis))
    assert frame.isTransform(1e-9)
    assert Position3D(frame.r1_c3, frame.r2_c3, frame.r3_c3).isNear(Position3D(axis).normalize(), 1e-12)
    placed = Transform(1.0, 2.0, 3.0)
    assert almath.orthogonalSpace(Position3D(axis), placed) is None
    assert placed == Transform(1.0, 2.0, 3.0) * frame


@pytest.mark.parametrize(
    "mask, about", [(1, almath.transformFromRotX), (2, almath.transformFromRotY), (4, almath.transformFromRotZ)]
)
def test_rotation_about_a_named_axis(mask, about):
    point = Position3D(1.0, 2.0, 3.0)
    assert almath.transformFromRotVec(mask, 0.4) == about(0.4)
    assert almath.transformFromRotVec(mask, 0.4, point) == Transform(1.0, 2.0, 3.0) * about(0.4)
    assert almath.transformFromRotVec(point) == Transform(1.0, 2.0, 3.0)
    out = Transform()
    almath.transformFromRotVecInPlace(mask, 0.4, point, out)
    assert out == almath.transformFromRotVec(mask, 0.4, point)


# Quaternions


def test_i_times_j_is_k():
    i, j, k = Quaternion(0, 1, 0, 0), Quaternion(0, 0, 1, 0), Quaternion(0, 0, 0, 1)
    assert (i * j, j * k, k * i) == (k, i, j)
    assert i * i == j * j == k * k == Quaternion(-1, 0, 0, 0)
    quaternion = Quaternion(1.0, 2.0, 3.0, 4.0)
    assert quaternion / 2.0 == Quaternion(0.5, 1.0, 1.5, 2.0)
    quaternion *= i
    assert quaternion == Quaternion(-2.0, 1.0, 4.0, -3.0)


@few
@given(quaternions, quaternions, points)
def test_a_quaternion_does_what_its_rotation_does(a, b, point):
    rotation = almath.rotationFromQuaternion(a)
    assert (a * point).isNear(rotation * point, 1e-9)
    assert almath.rotationFromQuaternion(a * b).isNear(rotation * almath.rotationFromQuaternion(b), 1e-9)
    assert (a * a.inverse()).isNear(Quaternion(), 1e-9)
    out = Quaternion()
    assert almath.quaternionInverse(a, out) is None
    assert out == almath.quaternionInverse(a) == a.inverse()
    assert a.isNear(a * -1.0) and a != a * -1.0
    assert almath.rotationFromQuaternion(a * 3.0).isNear(rotation, 1e-9)
    angle, *axis = almath.angleAndAxisRotationFromQuaternion(a)
    assert 0.0 <= angle <= 2.0 * math.pi and Position3D(axis).isUnitVector(1e-9)
    assert almath.quaternionFromAngleAndAxisRotation(angle, *axis).isNear(a, 1e-9)
    assert almath.quaternionFromTransform(almath.transformFromQuaternion(a)).isNear(a, 1e-9)


def test_half_angle_is_in_the_components_and_the_axis_has_any_length():
    quaternion = Quaternion.fromAngleAndAxisRotation(math.pi / 2, 0.0, 0.0, 5.0)
    assert quaternion.isNear(Quaternion(math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)), 1e-12)
    assert quaternion.norm() == pytest.approx(1.0)
    refused("no direction", almath.quaternionFromAngleAndAxisRotation, 0.8, 0.0, 0.0, 0.0)
    assert almath.angleAndAxisRotationFromQuaternion(Quaternion()) == [0.0, 1.0, 0.0, 0.0]
    assert not Quaternion().isNear(Quaternion(0.0, 1.0, 0.0, 0.0))
    assert not Quaternion().isNear(Quaternion(1.0, 0.001, 0.0, 0.0))


@pytest.mark.parametrize("about", [almath.transformFromRotX, almath.transformFromRotY, almath.transformFromRotZ])
def test_quaternion_of_half_a_turn_is_its_axis(about):
    w, *axis = almath.quaternionFromTransform(about(math.pi)).toVector()
    assert w == pytest.approx(0.0, abs=1e-12)
    assert sorted(map(abs, axis)) == pytest.approx([0.0, 0.0, 1.0])


# Transforms


@few
@given(transforms, transforms, points)
def test_transforms_agree_with_matrices(a, b, point):
    assert matrix_of(a * b) == pytest.approx(matrix_of(a) @ matrix_of(b))
    assert matrix_of(a.inverse()) == pytest.approx(numpy.linalg.inv(matrix_of(a)))
    assert (a * point).toVector() == pytest.approx((matrix_of(a) @ [*point.toVector(), 1.0])[:3])
    assert a.determinant() == pytest.approx(1.0)
    assert (a * a.diff(b)).isNear(b, 1e-9)
    assert almath.transformDiff(a, b) == a.diff(b)
    out, turned = Transform(), Transform(a)
    assert almath.transformInverse(a, out) is None
    almath.transformInvertInPlace(turned)
    assert a.inverse() == almath.transformInverse(a) == almath.pinv(a) == out == turned
    right, left, square = Transform(a), Transform(b), Transform(a)
    right *= b
    almath.transformPreMultiply(a, left)
    square *= square
    assert right == left == a * b and square == a * a


def test_translation_and_angles_turn_about_the_moved_origin():
    turn = almath.transformFromRotZ(0.3) * almath.transformFromRotY(0.2) * almath.transformFromRotX(0.1)
    chained = Transform(1.0, 2.0, 3.0) * turn
    assert almath.transformFromPosition(1.0, 2.0, 3.0, 0.1, 0.2, 0.3).isNear(chained, 1e-12)
    assert almath.transformFromPosition(1.0, 2.0, 3.0) == Transform.fromPosition(1, 2, 3) == Transform(1.0, 2.0, 3.0)
    assert almath.transformFrom3DRotation(0.1, 0.2, 0.3) == Transform.from3DRotation(0.1, 0.2, 0.3)
    assert Transform.from3DRotation(0.1, 0.2, 0.3).isNear(turn, 1e-12)


def test_distance_and_norm_are_those_of_the_origins():
    a, b = Transform.fromPosition(1.0, 2.0, 3.0, 1.0, 1.0, 1.0), Transform(1.0, 5.0, 7.0)
    assert a.distance(b) == almath.transformDistance(a, b) == 5.0
    assert a.distanceSquared(b) == almath.transformDistanceSquared(a, b) == 25.0
    assert Transform(2.0, 3.0, 6.0).norm() == 7.0


@few
@given(transforms, st.lists(st.floats(-0.01, 0.01), min_size=9, max_size=9))
def test_lists_of_12_and_16_numbers_make_the_transform_again_and_are_put_right(transform, noise):
    assert Transform(transform.toVector()) == transform
    assert Transform(almath.transformToFloatVector(transform)) == transform
    filled = []
    assert almath.transformToFloatVector(transform, filled) is None
    assert filled == transform.toVector()[:12] and transform.toVector()[12:] == [0.0, 0.0, 0.0, 1.0]
    assert transform.toVector(filled) is None
    assert filled == transform.toVector()
    numbers = numpy.array(filled)
    numbers[[0, 1, 2, 4, 5, 6, 8, 9, 10]] += noise
    repaired = Transform(numbers)
    assert repaired.isTransform(1e-9) and repaired.isNear(transform, 0.1)
    assert almath.position3DFromTransform(repaired) == almath.position3DFromTransform(transform)


# From one kind to another


@few
@given(positions)
def test_a_position_a_transform_and_their_parts(position):
    transform = almath.transformFromPosition6D(position)
    point, angles = position.toVector()[:3], position.toVector()[3:]
    rotation = Rotation.from3DRotation(*angles)
    assert almath.position6DFromTransform(transform).isNear(position, 1e-9)
    assert almath.position3DFromTransform(transform).toVector() == pytest.approx(point)
    assert almath.position2DFromTransform(transform).toVector() == pytest.approx(point[:2])
    assert almath.rotation3DFromTransform(transform).toVector() == pytest.approx(angles)
    assert almath.pose2DFromTransform(transform).toVector() == pytest.approx([*point[:2], position.wz])
    assert almath.rotationFromTransform(transform).isNear(rotation, 1e-12)
    quaternion = almath.quaternionFromRotation3D(almath.Rotation3D(angles))
    assert almath.rotationFromQuaternion(quaternion).isNear(rotation, 1e-9)
    assert almath.rotation3DFromQuaternion(quaternion).toVector() == pytest.approx(angles, abs=1e-9)
    parts = Quaternion(), Position3D()
    almath.quaternionPosition3DFromPosition6D(position, *parts)
    displacement = almath.Displacement(parts[1], parts[0])
    assert almath.transformFromDisplacement(displacement).isNear(transform, 1e-12)


@few
@given(transforms, transforms)
def test_quaternions_and_displacements_are_transforms_in_other_numbers(a, b):
    quaternion = almath.quaternionFromTransform(a)
    assert quaternion.w >= 0.0 and quaternion.norm() == pytest.approx(1.0)
    turned = almath.transformFromRotation(almath.rotationFromTransform(a))
    assert almath.transformFromQuaternion(quaternion).isNear(turned, 1e-9)
    first, second = almath.displacementFromTransform(a), almath.displacementFromTransform(b)
    assert almath.transformFromDisplacement(first).isNear(a, 1e-9)
    assert almath.transformFromDisplacement(first * second).isNear(a * b, 1e-9)
    first *= second
    assert first.isNear(almath.displacementFromTransform(a * b), 1e-9)


def test_rotation_from_a_quaternion_takes_it_whole_or_in_numbers():
    quaternion = almath.quaternionFromRotation3D(almath.Rotation3D(0.1, 0.2, 0.3))
    out = Rotation()
    assert almath.rotationFromQuaternion(quaternion, out) is None
    numbers = quaternion.toVector()
    for found in (out, almath.rotationFromQuaternion(*numbers), Rotation.fromQuaternion(*numbers)):
        assert found.isNear(Rotation.from3DRotation(0.1, 0.2, 0.3), 1e-12)
    refused("a Quaternion or four numbers", almath.rotationFromQuaternion, 1.0, 0.0, 0.0)


def test_points_poses_and_positions_keep_what_they_share():
    pose, point = almath.Pose2D(1.0, 2.0, 0.5), Position3D(1.0, 2.0, 3.0)
    transform = almath.transformFromPose2D(pose)
    assert transform.isNear(Transform(1.0, 2.0, 0.0) * Transform.fromRotZ(0.5), 1e-12)
    assert almath.pose2DFromTransform(transform).isNear(pose, 1e-12)
    assert almath.position2DFromPose2D(pose) == almath.Position2D(1.0, 2.0)
    assert almath.pose2DFromPosition2D(almath.Position2D(1.0, 2.0), 0.5) == pose
    assert almath.pose2DFromPosition2D(almath.Position2D(1.0, 2.0)) == almath.Pose2D(1.0, 2.0, 0.0)
    assert almath.position6DFromPose2D(pose) == Position6D(1.0, 2.0, 0.0, 0.0, 0.0, 0.5)
    assert almath.pose2DFromPosition6D(POSITION) == almath.Pose2D(0.1, -0.2, 0.6)
    assert almath.position6DFromPosition3D(point) == Position6D(1.0, 2.0, 3.0, 0.0, 0.0, 0.0)
    assert almath.position3DFromPosition6D(POSITION) == Position3D(0.1, -0.2, 0.3)
    assert almath.position6DFromVelocity6D(Velocity6D(POSITION.toVector())) == POSITION


def test_rotation_and_point_join_to_a_transform():
    rotation, point = Rotation.from3DRotation(0.4, -0.5, 0.6), Position3D(0.1, -0.2, 0.3)
    expected = almath.transformFromPosition6D(POSITION)
    assert almath.transformFromRotationPosition3D(rotation, point) == expected
    assert almath.transformFromRotationPosition3D(rotation, 0.1, -0.2, 0.3) == expected
    assert almath.transformFromPosition3D(point) * almath.transformFromRotation(rotation) == expected
    assert almath.transformFromRotation3D(almath.Rotation3D(0.4, -0.5, 0.6)) == almath.transformFromRotation(rotation)


@pytest.mark.parametrize(
    "function, value, out",
    [
        (almath.position2DFromPose2D, almath.Pose2D(1.0, 2.0, 0.5), almath.Position2D()),
        (almath.position2DFromTransform, Transform(1.0, 2.0, 3.0), almath.Position2D()),
        (almath.position3DFromTransform, Transform(1.0, 2.0, 3.0), Position3D()),
        (almath.position6DFromPose2D, almath.Pose2D(1.0, 2.0, 0.5), Position6D(9.0)),
        (almath.position6DFromPosition3D, Position3D(1.0, 2.0, 3.0), Position6D(9.0)),
        (almath.position6DFromTransform, almath.transformFromPosition6D(POSITION), Position6D()),
        (almath.pose2DFromPosition6D, POSITION, almath.Pose2D()),
        (almath.pose2DFromTransform, almath.transformFromPosition6D(POSITION), almath.Pose2D()),
        (almath.rotationFromTransform, almath.transformFromPosition6D(POSITION), Rotation()),
        (almath.transformFromPose2D, almath.Pose2D(1.0, 2.0, 0.5), Transform(7.0, 8.0, 9.0)),
    ],
    ids=lambda case: getattr(case, "__name__", ""),
)
def test_in_place_forms_write_what_the_others_return(function, value, out):
    in_place = getattr(almath, function.__name__ + "InPlace")
    assert in_place(value, out) is None
    assert out == function(value)


def test_in_place_forms_that_write_a_part_keep_the_other():
    transform = almath.transformFromPosition6D(POSITION)
    almath.transformFromPosition3DInPlace(Position3D(1.0, 2.0, 3.0), transform)
    almath.transformFromRotationInPlace(Rotation(), transform)
    assert transform == Transform(1.0, 2.0, 3.0)
    pose = almath.Pose2D()
    almath.pose2DFromPosition2DInPlace(almath.Position2D(1.0, 2.0), 0.5, pose)
    assert pose == almath.Pose2D(1.0, 2.0, 0.5)


# In turned axes


@few
@given(transforms, transforms, st.lists(metres, min_size=6, max_size=6))
def test_changing_the_reference_turns_each_triple_and_moves_nothing(turn, other, numbers):
    rotation = matrix_of(almath.rotationFromTransform(turn))
    for name, kind, size in (
        ("Position3D", Position3D, 3),
        ("Position6D", Position6D, 6),
        ("Velocity6D", Velocity6D, 6),
    ):
        vector, turned, again = kind(numbers[:size]), kind(), kind()
        getattr(almath, f"changeReference{name}")(turn, vector, turned)
        assert turned.toVector() == pytest.approx((rotation @ numpy.reshape(numbers[:size], (-1, 3)).T).T.ravel())
        getattr(almath, f"changeReferenceTranspose{name}")(turn, turned, again)
        assert again.isNear(vector, 1e-9)
    point = Position3D(numbers[:3])
    almath.changeReferencePosition3DInPlace(turn, point)
    assert point.toVector() == pytest.approx(rotation @ numbers[:3])
    almath.changeReferenceTransposePosition3DInPlace(turn, point)
    assert point.isNear(Position3D(numbers[:3]), 1e-9)
    out, again = Transform(), Transform()
    almath.changeReferenceTransform(turn, other, out)
    assert out.isNear(almath.transformFromRotation(almath.rotationFromTransform(turn)) * other, 1e-12)
    almath.changeReferenceTransposeTransform(turn, out, again)
    assert again.isNear(other, 1e-9)


def test_pose_is_turned_about_the_origin_and_keeps_its_heading():
    out = almath.Pose2D()
    almath.changeReferencePose2D(almath.PI_2, almath.Pose2D(1.0, 2.0, 0.5), out)
    assert out.isNear(almath.Pose2D(-2.0, 1.0, 0.5), 1e-12)
    almath.changeReferencePose2DInPlace(-almath.PI_2, out)
    assert out.isNear(almath.Pose2D(1.0, 2.0, 0.5), 1e-12)


# Screws


def power_series(velocity, terms=40):
    """Exponential of the 4x4 matrix of a body velocity, summed term by term."""
    x, y, z, wx, wy, wz = velocity.toVector()
    generator = numpy.array([[0, -wz, wy, x], [wz, 0, -wx, y], [-wy, wx, 0, z], [0, 0, 0, 0]])
    total = term = numpy.eye(4)
    for order in range(1, terms):
        term = term @ generator / order
        total = total + term
    return total


@pytest.mark.parametrize("angle", [0.0, 1e-10, 0.9e-4, 1.1e-4, 1.0, math.pi - 1e-7])
@settings(max_examples=6)
@given(points, axes)
def test_exponential_is_the_power_series_and_the_logarithm_finds_it_again(angle, linear, axis):
    velocity = Velocity6D(*linear.toVector(), *(angle * axis.normalize()).toVector())
    transform = almath.velocityExponential(velocity)
    assert matrix_of(transform) == pytest.approx(power_series(velocity), abs=1e-8)
    assert almath.transformLogarithm(transform).isNear(velocity, 1e-6)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-0.48, 0.6, 0.64)])
def test_logarithm_of_half_a_turn_leads_there(axis):
    turn = almath.rotationFromAngleDirection(math.pi, *axis)
    transform = almath.transformFromRotationPosition3D(turn, 0.3, -0.2, 0.1)
    assert almath.velocityExponential(almath.transformLogarithm(transform)).isNear(transform, 1e-9)


@few
@given(transforms, transforms, st.floats(0.0, 1.0))
def test_logarithm_and_mean_lead_from_one_transform_to_the_other(start, end, share):
    velocity = almath.transformLogarithm(start)
    assert math.sqrt(velocity.wxd**2 + velocity.wyd**2 + velocity.wzd**2) <= math.pi + 1e-9
    assert almath.velocityExponential(velocity).isNear(start, 1e-8)
    assert almath.transformMean(start, end, 0.0).isNear(start, 1e-8)
    assert almath.transformMean(start, end, 1.0).isNear(end, 1e-8)
    middle = almath.transformMean(start, end)
    assert start.diff(middle).isNear(middle.diff(end), 1e-8)
    found, transform, position = Velocity6D(), Transform(), Position6D()
    almath.transformLogarithmInPlace(start, found)
    almath.velocityExponentialInPlace(found, transform)
    assert (found, transform) == (velocity, almath.velocityExponential(velocity))
    almath.transformMeanInPlace(start, end, share, transform)
    assert transform == almath.transformMean(start, end, share)
    almath.position6DFromTransformDiffInPlace(start, end, position)
    assert position == almath.position6DFromTransformDiff(start, end)


def test_mean_of_translations_and_of_turns_about_one_axis():
    straight = almath.transformMean(Transform(), Transform(1.0, 2.0, 4.0), 0.25)
    assert straight.isNear(Transform(0.25, 0.5, 1.0), 1e-12)
    turned = almath.transformMean(Transform.fromRotX(0.2), Transform.fromRotX(1.0), 0.75)
    assert turned.isNear(Transform.fromRotX(0.8), 1e-12)
    for share in (-0.1, 1.1, math.nan):
        refused(r"share in \[0, 1\]", almath.transformMean, Transform(), Transform(), share)


@few
@given(transforms, points, axes, pitches)
def test_difference_is_the_translation_and_the_sine_of_the_rotation(current, target, axis, angle):
    turn = almath.rotationFromAngleDirection(angle, axis.normalize())
    end = almath.transformFromRotationPosition3D(turn * almath.rotationFromTransform(current), target)
    moved = target - almath.position3DFromTransform(current)
    expected = Position6D(*moved.toVector(), *(axis.normalize() * math.sin(angle)).toVector())
    assert almath.position6DFromTransformDiff(current, end).isNear(expected, 1e-9)
