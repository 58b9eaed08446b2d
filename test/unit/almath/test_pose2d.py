"""Poses on the floor."""

import math

import pytest

import almath


def random_pose(rng):
    return almath.Pose2D(*rng.uniform(-2.0, 2.0, 2), rng.uniform(-6.0, 6.0))


def test_a_pose_places_what_lies_ahead_along_its_heading():
    facing_left = almath.Pose2D(1.0, 2.0, math.pi / 2)
    assert (facing_left * almath.Pose2D(3.0, 0.0, 0.5)).isNear(almath.Pose2D(1.0, 5.0, math.pi / 2 + 0.5), 1e-12)
    assert (facing_left * almath.Position2D(0.0, 1.0)).isNear(almath.Position2D(0.0, 2.0), 1e-12)


def test_inverse_has_the_value_worked_out_by_hand():
    c, s = math.cos(0.5), math.sin(0.5)
    expected = almath.Pose2D(-(c * 0.1 - s * -0.1), -(s * 0.1 + c * -0.1), 0.5)
    assert almath.Pose2D(0.1, -0.1, -0.5).inverse().isNear(expected, 1e-12)
    assert almath.Pose2D(0.1, -0.1, -0.5).inverse().isNear(almath.Pose2D(-0.135701, 0.0398157, 0.5), 1e-6)


def test_a_pose_times_its_inverse_is_the_origin(rng):
    for _ in range(50):
        pose = random_pose(rng)
        assert (pose * pose.inverse()).isNear(almath.Pose2D(), 1e-9)
        assert (pose.inverse() * pose).isNear(almath.Pose2D(), 1e-9)


def test_chaining_is_associative_and_agrees_with_transforms(rng):
    for _ in range(50):
        a, b, c = (random_pose(rng) for _ in range(3))
        assert ((a * b) * c).isNear(a * (b * c), 1e-9)
        product = almath.transformFromPose2D(a) * almath.transformFromPose2D(b)
        assert almath.transformFromPose2D(a * b).isNear(product, 1e-9)


def test_diff_is_the_motion_from_one_pose_to_the_other(rng):
    for _ in range(50):
        start, end = random_pose(rng), random_pose(rng)
        assert (start * start.diff(end)).isNear(end, 1e-9)
        assert almath.pose2dDiff(start, end) == start.diff(end)


def test_all_spellings_of_the_inverse_agree(rng):
    pose = random_pose(rng)
    out, turned = almath.Pose2D(), almath.Pose2D(pose)
    assert almath.pose2DInverse(pose, out) is None
    almath.pose2dInvertInPlace(turned)
    assert pose.inverse() == almath.pose2DInverse(pose) == almath.pinv(pose) == out == turned


def test_in_place_product_is_a_product_or_a_multiple():
    pose = almath.Pose2D(1.0, 2.0, math.pi)
    pose *= almath.Pose2D(1.0, 0.0, 0.5)
    assert pose.isNear(almath.Pose2D(0.0, 2.0, math.pi + 0.5), 1e-12)
    pose *= 2.0
    assert pose.isNear(almath.Pose2D(0.0, 4.0, 2.0 * math.pi + 1.0), 1e-12)
    with pytest.raises(almath.AlmathError, match="would not leave a Pose2D"):
        pose *= almath.Position2D(1.0, 0.0)


def test_distance_and_norm_ignore_the_heading():
    assert almath.Pose2D(3.0, 4.0, 9.0).norm() == 5.0
    assert almath.Pose2D(1.0, 1.0, 0.0).distance(almath.Pose2D(4.0, 5.0, 2.0)) == 5.0
    assert almath.Pose2D(1.0, 1.0, 0.0).distanceSquared(almath.Pose2D(4.0, 5.0, 2.0)) == 25.0


def test_normalize_keeps_direction_and_heading():
    assert almath.Pose2D(3.0, 4.0, 9.0).normalize().isNear(almath.Pose2D(0.6, 0.8, 9.0), 1e-12)
    with pytest.raises(almath.AlmathError, match="no direction"):
        almath.Pose2D(0.00005, 0.0, 1.0).normalize()


def test_polar_coordinates_head_away_from_the_origin():
    pose = almath.Pose2D.fromPolarCoordinates(2.0, 0.7)
    assert pose.isNear(almath.Pose2D(2.0 * math.cos(0.7), 2.0 * math.sin(0.7), 0.7), 1e-12)
    assert almath.Pose2D_fromPolarCoordinates(2.0, 0.7) == pose
    assert almath.Pose2D(0.0, 3.0, 1.0).getAngle() == math.pi / 2
