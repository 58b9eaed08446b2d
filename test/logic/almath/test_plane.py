"""Points and poses of the floor and of space, footsteps, and paths of two arcs and a straight piece."""

from __future__ import annotations

import math

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import almath
from almath import AlmathError, Pose2D, Position2D, Position3D, Position6D

few = settings(max_examples=20)
metres = st.floats(-2.0, 2.0)
poses = st.builds(Pose2D, metres, metres, st.floats(-6.0, 6.0))
triples = st.lists(metres, min_size=3, max_size=3)


def refused(told, function, *arguments):
    with pytest.raises(AlmathError, match=told):
        function(*arguments)


# Poses


def test_a_pose_places_what_lies_ahead_along_its_heading():
    facing_left = Pose2D(1.0, 2.0, math.pi / 2)
    assert (facing_left * Pose2D(3.0, 0.0, 0.5)).isNear(Pose2D(1.0, 5.0, math.pi / 2 + 0.5), 1e-12)
    assert (facing_left * Position2D(0.0, 1.0)).isNear(Position2D(0.0, 2.0), 1e-12)
    assert Pose2D(0.1, -0.1, -0.5).inverse().isNear(Pose2D(-0.135701, 0.0398157, 0.5), 1e-6)


@few
@given(poses, poses, poses)
def test_poses_are_a_group_that_agrees_with_transforms(a, b, c):
    assert (a * a.inverse()).isNear(Pose2D(), 1e-9) and (a.inverse() * a).isNear(Pose2D(), 1e-9)
    assert ((a * b) * c).isNear(a * (b * c), 1e-9)
    product = almath.transformFromPose2D(a) * almath.transformFromPose2D(b)
    assert almath.transformFromPose2D(a * b).isNear(product, 1e-9)
    assert (a * a.diff(b)).isNear(b, 1e-9)
    assert almath.pose2dDiff(a, b) == a.diff(b)
    out, turned = Pose2D(), Pose2D(a)
    assert almath.pose2DInverse(a, out) is None
    almath.pose2dInvertInPlace(turned)
    assert a.inverse() == almath.pose2DInverse(a) == almath.pinv(a) == out == turned


def test_length_and_direction_of_a_pose_ignore_the_heading():
    assert Pose2D(3.0, 4.0, 9.0).norm() == 5.0
    assert Pose2D(1.0, 1.0, 0.0).distance(Pose2D(4.0, 5.0, 2.0)) == 5.0
    assert Pose2D(1.0, 1.0, 0.0).distanceSquared(Pose2D(4.0, 5.0, 2.0)) == 25.0
    assert Pose2D(3.0, 4.0, 9.0).normalize().isNear(Pose2D(0.6, 0.8, 9.0), 1e-12)
    refused("no direction", Pose2D(0.00005, 0.0, 1.0).normalize)
    assert Pose2D(0.0, 3.0, 1.0).getAngle() == math.pi / 2


@pytest.mark.parametrize("angle", [-3.0, -math.pi / 2, 0.0, 0.7, math.pi])
def test_polar_coordinates_and_angle_are_inverse(angle):
    point = Position2D.fromPolarCoordinates(2.0, angle)
    assert point.toVector() == pytest.approx([2.0 * math.cos(angle), 2.0 * math.sin(angle)])
    assert point.getAngle() == pytest.approx(angle)
    assert Pose2D.fromPolarCoordinates(2.0, angle).isNear(Pose2D(point.x, point.y, angle), 1e-12)


# Points and vectors


@pytest.mark.parametrize("kind", [Position2D, Position3D, Position6D, almath.Velocity3D, almath.Velocity6D])
def test_norm_is_the_euclidean_length_and_normalize_keeps_the_direction(kind):
    numbers = [3.0, -4.0, 12.0, 1.0, 2.0, -0.5][: len(kind().toVector())]
    vector = kind(numbers)
    assert vector.norm() == pytest.approx(numpy.linalg.norm(numbers))
    unit = vector.normalize()
    assert unit.norm() == pytest.approx(1.0) and (unit * vector.norm()).isNear(vector, 1e-9)
    assert almath.normalize(vector) == unit
    refused("norm is zero", kind().normalize)


@few
@given(triples, triples)
def test_products_and_distances_of_vectors_agree_with_numpy(a, b):
    p, q = Position3D(a), Position3D(b)
    assert p.dotProduct(q) == pytest.approx(numpy.dot(a, b))
    assert p.crossProduct(q).toVector() == pytest.approx(numpy.cross(a, b))
    for kind, size in ((Position2D, 2), (Position3D, 3), (Position6D, 3)):
        left, right = ([*n[:size], *(n[:3] if kind is Position6D else ())] for n in (a, b))
        distance = numpy.linalg.norm(numpy.subtract(a, b)[:size])  # angles do not count
        assert kind(left).distance(kind(right)) == pytest.approx(distance)
        assert kind(left).distanceSquared(kind(right)) == pytest.approx(distance**2)


def test_cross_products_turn_to_the_left():
    assert Position3D(1, 0, 0).crossProduct(Position3D(0, 1, 0)) == Position3D(0, 0, 1)
    ahead, left = Position2D(1.0, 0.0), Position2D(0.0, 2.0)
    assert (ahead.crossProduct(left), left.crossProduct(ahead), ahead.dotProduct(left)) == (2.0, -2.0, 0.0)
    refused("Position2D.distanceSquared takes a Position2D", Position2D().distance, Position3D())


# Footsteps. Corners of the feet of a NAO, in m: front left, front right, rear right, rear left.
LEFT_FOOT = [Position2D(*c) for c in ((0.080, 0.050), (0.080, -0.038), (-0.047, -0.038), (-0.047, 0.050))]
RIGHT_FOOT = [Position2D(*c) for c in ((0.080, 0.038), (0.080, -0.050), (-0.047, -0.050), (-0.047, 0.038))]
SQUARE = [Position2D(*c) for c in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
DEGREES_40 = 40.0 * almath.TO_RAD


def placed(box, *pose):
    moved = []
    almath.computeBox(box, Pose2D(*pose), moved)
    return moved


@pytest.mark.parametrize(
    "step, clipped, place",
    [
        ((0.05, 0.04), False, (0.05, 0.04)),
        ((0.08, 0.06), True, (0.08 / math.sqrt(2), 0.06 / math.sqrt(2))),
        ((-0.08, -0.05), True, (-0.06145, -0.03841)),
        ((0.0, -0.20), True, (0.0, -0.06)),
    ],
)
def test_steps_outside_the_ellipse_are_shortened_to_it(step, clipped, place):
    pose = Pose2D(*step, 0.5)
    assert almath.clipFootWithEllipse(0.08, 0.06, pose) is clipped
    assert pose.isNear(Pose2D(*place, 0.5), 1e-5)


@pytest.mark.parametrize(
    "left_is_support, step, collides, theta",
    [
        (False, (0.0, 0.1, 0.0), False, 0.0),
        (False, (0.0, 0.085, DEGREES_40), True, DEGREES_40 * 9 / 32),
        (True, (0.0, -0.085, -DEGREES_40), True, -DEGREES_40 * 9 / 32),
        (False, (0.0, 0.02, 0.3), True, 0.0),  # onto the other foot: no heading helps
    ],
)
def test_a_step_that_turns_into_the_other_foot_is_turned_less(left_is_support, step, collides, theta):
    pose = Pose2D(*step)
    assert almath.avoidFootCollision(LEFT_FOOT, RIGHT_FOOT, left_is_support, pose) is collides
    assert pose.isNear(Pose2D(*step[:2], theta), 1e-12)


@pytest.mark.parametrize(
    "pose, collides",
    [
        ((0.0, 0.0, 0.0), True),
        ((2.0, 0.0, 0.0), True),
        ((2.1, 0.0, 0.0), False),
        ((2.1, 0.0, math.pi / 4), True),
        ((2.1, 2.1, math.pi / 4), False),
    ],
)
def test_squares_collide_where_they_share_a_point(pose, collides):
    other = placed(SQUARE, *pose)
    for a, b in ((SQUARE, other), (other, SQUARE), (SQUARE[::-1], other)):
        assert almath.areTwoBoxesInCollision(a, b) is collides


@pytest.mark.parametrize(
    "b_start, b_end, shared",
    [
        ((-1.0, 0.0), (1.0, 0.0), (0.0, 0.0)),
        ((-1.0, 1.0), (1.0, 1.0), (0.0, 1.0)),
        ((0.0, 0.5), (1.0, 0.5), (0.0, 0.5)),
        ((-1.0, 1.0001), (1.0, 1.0001), None),
        ((0.5, 0.0), (1.5, 0.0), None),
        ((-1.0, 0.0), (-0.2, 0.0), None),
        ((0.0, 0.0), (0.0, 2.0), None),
        ((-1.0, -1.0), (1.0, 0.5), (0.0, -0.25)),
    ],
)
def test_segments_share_one_point_or_none(b_start, b_end, shared):
    out = Position2D(9.0, 9.0)
    ends = [Position2D(point) for point in ((0.0, -1.0), (0.0, 1.0), b_start, b_end)]
    assert almath.intersectionSegment2D(*ends, out) is (shared is not None)
    assert out.isNear(Position2D(shared or (9.0, 9.0)), 1e-12)


# Dubins paths: what the library of the SDK gives for a radius of 0.1 m; target, start and end of the straight piece.


@pytest.mark.parametrize(
    "target, checkpoints",
    [
        ((0.5, 0.5, 0.0), [(0.0777402, 0.0370996, 0.890525), (0.422260, 0.462900, 0.890525)]),
        ((-0.5, 0.5, 0.3), [(0.0207914, 0.197815, 2.93215), (-0.491239, 0.306652, 2.93215)]),
        ((0.0, -1.0, 0.3), [(0.0958873, -0.128384, -1.85859), (-0.125439, -0.876083, -1.85859)]),
    ],
)
def test_known_paths(target, checkpoints):
    path = almath.getDubinsSolutions(Pose2D(*target), 0.1)
    assert len(path) == 3
    for pose, expected in zip(path, [*checkpoints, target]):
        assert pose.isNear(Pose2D(*expected), 1e-5)


def test_straight_ahead_there_is_no_turn_and_targets_too_near_are_refused():
    start, end, _ = almath.getDubinsSolutions(Pose2D(1.0, 0.0, 0.0), 0.1)
    assert (start.x, start.y, end.y) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    refused("four radii", almath.getDubinsSolutions, Pose2D(0.39, 0.0, 0.0), 0.1)
    refused("radius above zero", almath.getDubinsSolutions, Pose2D(1.0, 0.0, 0.0), 0.0)
