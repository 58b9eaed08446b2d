"""From one kind of position or rotation to another, and back."""

import math

import pytest

import almath

POSITION = almath.Position6D(0.1, -0.2, 0.3, 0.4, -0.5, 0.6)


@pytest.fixture
def random_positions(rng):
    """Positions whose angles are the ones a transform gives back: the pitch stays below a right angle."""
    return [
        almath.Position6D(
            *rng.uniform(-2, 2, 3), rng.uniform(-3.1, 3.1), rng.uniform(-1.5, 1.5), rng.uniform(-3.1, 3.1)
        )
        for _ in range(100)
    ]


def test_position_and_transform_are_inverse(random_positions, random_transforms):
    for position in random_positions:
        transform = almath.transformFromPosition6D(position)
        assert almath.position6DFromTransform(transform).isNear(position, 1e-9)
    for transform in random_transforms:
        assert almath.transformFromPosition6D(almath.position6DFromTransform(transform)).isNear(transform, 1e-9)


def test_parts_of_a_transform(random_positions):
    for position in random_positions:
        transform = almath.transformFromPosition6D(position)
        point, angles = position.toVector()[:3], position.toVector()[3:]
        assert almath.position3DFromTransform(transform).toVector() == pytest.approx(point)
        assert almath.position2DFromTransform(transform).toVector() == pytest.approx(point[:2])
        assert almath.rotation3DFromTransform(transform).toVector() == pytest.approx(angles)
        assert almath.pose2DFromTransform(transform).toVector() == pytest.approx([*point[:2], position.wz])
        assert almath.rotationFromTransform(transform).isNear(almath.Rotation.from3DRotation(*angles), 1e-12)


def test_transform_of_a_pose_lies_on_the_floor():
    pose = almath.Pose2D(1.0, 2.0, 0.5)
    transform = almath.transformFromPose2D(pose)
    assert transform.isNear(almath.Transform(1.0, 2.0, 0.0) * almath.Transform.fromRotZ(0.5), 1e-12)
    assert almath.pose2DFromTransform(transform).isNear(pose, 1e-12)


def test_quaternion_and_transform_are_inverse(random_transforms, random_quaternions):
    for transform in random_transforms:
        quaternion = almath.quaternionFromTransform(transform)
        rotation = almath.transformFromRotation(almath.rotationFromTransform(transform))
        assert quaternion.w >= 0.0
        assert quaternion.norm() == pytest.approx(1.0)
        assert almath.transformFromQuaternion(quaternion).isNear(rotation, 1e-9)
    for quaternion in random_quaternions:
        again = almath.quaternionFromTransform(almath.transformFromQuaternion(quaternion))
        assert again.isNear(quaternion, 1e-9)


@pytest.mark.parametrize("about", [almath.transformFromRotX, almath.transformFromRotY, almath.transformFromRotZ])
def test_quaternion_of_half_a_turn_is_its_axis(about):
    w, *axis = almath.quaternionFromTransform(about(math.pi)).toVector()
    assert w == pytest.approx(0.0, abs=1e-12)
    assert sorted(map(abs, axis)) == pytest.approx([0.0, 0.0, 1.0])


def test_quaternion_and_angles_are_inverse(random_positions):
    for position in random_positions:
        angles = almath.Rotation3D(position.wx, position.wy, position.wz)
        quaternion = almath.quaternionFromRotation3D(angles)
        rotation = almath.Rotation.from3DRotation(*angles.toVector())
        assert almath.rotationFromQuaternion(quaternion).isNear(rotation, 1e-9)
        assert almath.rotation3DFromQuaternion(quaternion).isNear(angles, 1e-9)


def test_rotation_from_a_quaternion_takes_it_whole_or_in_numbers():
    quaternion = almath.quaternionFromRotation3D(almath.Rotation3D(0.1, 0.2, 0.3))
    rotation = almath.Rotation.from3DRotation(0.1, 0.2, 0.3)
    out = almath.Rotation()
    assert almath.rotationFromQuaternion(quaternion, out) is None
    for found in (
        out,
        almath.rotationFromQuaternion(quaternion),
        almath.rotationFromQuaternion(*quaternion.toVector()),
    ):
        assert found.isNear(rotation, 1e-12)
    assert almath.Rotation_fromQuaternion(*quaternion.toVector()).isNear(rotation, 1e-12)
    with pytest.raises(almath.AlmathError, match="a Quaternion or four numbers"):
        almath.rotationFromQuaternion(1.0, 0.0, 0.0)


def test_displacement_is_a_transform_in_other_numbers(random_transforms):
    for a, b in zip(random_transforms, random_transforms[1:]):
        first, second = almath.displacementFromTransform(a), almath.displacementFromTransform(b)
        assert almath.transformFromDisplacement(first).isNear(a, 1e-9)
        assert almath.transformFromDisplacement(first * second).isNear(a * b, 1e-9)
        first *= second
        assert first.isNear(almath.displacementFromTransform(a * b), 1e-9)
    assert almath.transformFromDisplacement(almath.Displacement()) == almath.Transform()
    assert not first.isNear(almath.Displacement(first.P))
    assert not first.isNear(almath.Displacement(None, first.Q))


def test_points_poses_and_positions_keep_what_they_share():
    pose, point = almath.Pose2D(1.0, 2.0, 0.5), almath.Position3D(1.0, 2.0, 3.0)
    assert almath.position2DFromPose2D(pose) == almath.Position2D(1.0, 2.0)
    assert almath.pose2DFromPosition2D(almath.Position2D(1.0, 2.0), 0.5) == pose
    assert almath.pose2DFromPosition2D(almath.Position2D(1.0, 2.0)) == almath.Pose2D(1.0, 2.0, 0.0)
    assert almath.position6DFromPose2D(pose) == almath.Position6D(1.0, 2.0, 0.0, 0.0, 0.0, 0.5)
    assert almath.pose2DFromPosition6D(POSITION) == almath.Pose2D(0.1, -0.2, 0.6)
    assert almath.position6DFromPosition3D(point) == almath.Position6D(1.0, 2.0, 3.0, 0.0, 0.0, 0.0)
    assert almath.position3DFromPosition6D(POSITION) == almath.Position3D(0.1, -0.2, 0.3)
    velocity = almath.Velocity6D(POSITION.toVector())
    assert almath.position6DFromVelocity6D(velocity) == POSITION


def test_rotation_and_point_join_to_a_transform():
    rotation = almath.Rotation.from3DRotation(0.4, -0.5, 0.6)
    expected = almath.transformFromPosition6D(POSITION)
    point = almath.position3DFromPosition6D(POSITION)
    assert almath.transformFromRotationPosition3D(rotation, point) == expected
    assert almath.transformFromRotationPosition3D(rotation, 0.1, -0.2, 0.3) == expected
    assert almath.transformFromPosition3D(point) * almath.transformFromRotation(rotation) == expected
    assert almath.transformFromRotation3D(almath.Rotation3D(0.4, -0.5, 0.6)) == almath.transformFromRotation(rotation)


IN_PLACE = [
    (almath.position2DFromPose2D, almath.Pose2D(1.0, 2.0, 0.5), almath.Position2D()),
    (almath.position2DFromTransform, almath.Transform(1.0, 2.0, 3.0), almath.Position2D()),
    (almath.position3DFromTransform, almath.Transform(1.0, 2.0, 3.0), almath.Position3D()),
    (almath.position6DFromPose2D, almath.Pose2D(1.0, 2.0, 0.5), almath.Position6D(9.0)),
    (almath.position6DFromPosition3D, almath.Position3D(1.0, 2.0, 3.0), almath.Position6D(9.0)),
    (almath.position6DFromTransform, almath.transformFromPosition6D(POSITION), almath.Position6D()),
    (almath.pose2DFromPosition6D, POSITION, almath.Pose2D()),
    (almath.pose2DFromTransform, almath.transformFromPosition6D(POSITION), almath.Pose2D()),
    (almath.rotationFromTransform, almath.transformFromPosition6D(POSITION), almath.Rotation()),
    (almath.transformFromPose2D, almath.Pose2D(1.0, 2.0, 0.5), almath.Transform(7.0, 8.0, 9.0)),
]


@pytest.mark.parametrize("function, value, out", IN_PLACE, ids=lambda case: getattr(case, "__name__", ""))
def test_in_place_forms_write_what_the_others_return(function, value, out):
    in_place = getattr(almath, function.__name__ + "InPlace")
    assert in_place(value, out) is None
    assert out == function(value)
    with pytest.raises(almath.AlmathError, match=f"{function.__name__}InPlace takes a {type(out).__name__}, got None"):
        in_place(value, None)


def test_in_place_forms_that_write_a_part_keep_the_other():
    transform = almath.transformFromPosition6D(POSITION)
    almath.transformFromPosition3DInPlace(almath.Position3D(1.0, 2.0, 3.0), transform)
    almath.transformFromRotationInPlace(almath.Rotation(), transform)
    assert transform == almath.Transform(1.0, 2.0, 3.0)
    pose = almath.Pose2D()
    almath.pose2DFromPosition2DInPlace(almath.Position2D(1.0, 2.0), 0.5, pose)
    assert pose == almath.Pose2D(1.0, 2.0, 0.5)


def test_position_splits_into_quaternion_and_point():
    quaternion, point = almath.Quaternion(), almath.Position3D()
    almath.quaternionPosition3DFromPosition6D(POSITION, quaternion, point)
    displacement = almath.Displacement(point, quaternion)
    assert almath.transformFromDisplacement(displacement).isNear(almath.transformFromPosition6D(POSITION), 1e-12)


def test_arguments_of_another_class_are_named():
    with pytest.raises(almath.AlmathError, match=r"transformFromPosition6D takes a Position6D, got Pose2D\(x=0"):
        almath.transformFromPosition6D(almath.Pose2D())
