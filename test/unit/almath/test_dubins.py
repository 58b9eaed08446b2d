"""Paths of two arcs and a straight piece."""

import math

import pytest

import almath

# What the library of the SDK gives for a radius of 0.1 m: target, then start and end of the straight piece.
KNOWN = [
    ((0.5, 0.5, 0.0), [(0.0777402, 0.0370996, 0.890525), (0.422260, 0.462900, 0.890525)]),
    ((-0.5, 0.5, 0.3), [(0.0207914, 0.197815, 2.93215), (-0.491239, 0.306652, 2.93215)]),
    ((0.0, -1.0, 0.3), [(0.0958873, -0.128384, -1.85859), (-0.125439, -0.876083, -1.85859)]),
]


@pytest.mark.parametrize("target, checkpoints", KNOWN)
def test_known_paths(target, checkpoints):
    path = almath.getDubinsSolutions(almath.Pose2D(*target), 0.1)
    assert len(path) == 3
    for pose, expected in zip(path, [*checkpoints, target]):
        assert pose.isNear(almath.Pose2D(*expected), 1e-5)


def driven(pose, turn, radius):
    """Pose after an arc by the angle `turn`, to the left if it is positive."""
    centre = pose * almath.Position2D(0.0, math.copysign(radius, turn))
    arm = almath.position2DFromPose2D(pose) - centre
    turned = almath.Pose2D(0.0, 0.0, turn) * arm
    return almath.Pose2D(centre.x + turned.x, centre.y + turned.y, pose.theta + turn)


def test_driving_arc_straight_and_arc_leads_to_the_target(rng):
    for _ in range(200):
        radius = rng.uniform(0.05, 0.4)
        target = almath.Pose2D.fromPolarCoordinates(rng.uniform(4.0, 10.0) * radius, rng.uniform(-3.1, 3.1))
        target.theta = rng.uniform(-3.1, 3.1)
        start, end, last = almath.getDubinsSolutions(target, radius)
        assert last == target
        assert abs(start.theta) <= 2.0 * math.pi
        assert driven(almath.Pose2D(), start.theta, radius).isNear(start, 1e-9)
        straight = almath.Pose2D(start.distance(end), 0.0, 0.0)
        assert math.remainder((start * straight).theta - end.theta, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)
        assert (start * straight).distance(end) < 1e-9
        assert driven(end, target.theta - end.theta, radius).isNear(target, 1e-9)


def test_straight_ahead_there_is_no_turn():
    start, end, _ = almath.getDubinsSolutions(almath.Pose2D(1.0, 0.0, 0.0), 0.1)
    assert (start.x, start.y, end.y) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_targets_too_near_and_radii_without_a_circle_are_refused():
    with pytest.raises(almath.AlmathError, match="four radii"):
        almath.getDubinsSolutions(almath.Pose2D(0.39, 0.0, 0.0), 0.1)
    with pytest.raises(almath.AlmathError, match="radius above zero"):
        almath.getDubinsSolutions(almath.Pose2D(1.0, 0.0, 0.0), 0.0)
