"""Clipping of footsteps."""

import math

import pytest

import almath

# Corners of the feet of a NAO, in m: front left, front right, rear right, rear left.
LEFT_FOOT = [almath.Position2D(*c) for c in ((0.080, 0.050), (0.080, -0.038), (-0.047, -0.038), (-0.047, 0.050))]
RIGHT_FOOT = [almath.Position2D(*c) for c in ((0.080, 0.038), (0.080, -0.050), (-0.047, -0.050), (-0.047, 0.038))]
SQUARE = [almath.Position2D(*c) for c in ((1, 1), (1, -1), (-1, -1), (-1, 1))]


def placed(box, *pose):
    moved = []
    almath.computeBox(box, almath.Pose2D(*pose), moved)
    return moved


@pytest.mark.parametrize(
    "step, clipped, place",
    [
        ((0.05, 0.04), False, (0.05, 0.04)),
        ((0.08, 0.06), True, (0.08 / math.sqrt(2), 0.06 / math.sqrt(2))),
        ((-0.08, -0.05), True, (-0.06145, -0.03841)),
        ((0.0, 0.06), False, (0.0, 0.06)),
        ((0.0, -0.20), True, (0.0, -0.06)),
    ],
)
def test_steps_outside_the_ellipse_are_shortened_to_it(step, clipped, place):
    pose = almath.Pose2D(*step, 0.5)
    assert almath.clipFootWithEllipse(0.08, 0.06, pose) is clipped
    assert pose.isNear(almath.Pose2D(*place, 0.5), 1e-5)


def test_clipped_steps_lie_on_the_ellipse_in_the_old_direction_and_stay(rng):
    for _ in range(100):
        step = almath.Pose2D(*rng.uniform(-0.3, 0.3, 3))
        before = almath.Pose2D(step)
        if almath.clipFootWithEllipse(-0.04, 0.16, step):
            assert (step.x / 0.04) ** 2 + (step.y / 0.16) ** 2 == pytest.approx(1.0)
            assert step.getAngle() == pytest.approx(before.getAngle())
            assert step.norm() < before.norm()
            assert not almath.clipFootWithEllipse(-0.04, 0.16, step)
        else:
            assert step == before


def test_an_ellipse_needs_both_axes():
    with pytest.raises(almath.AlmathError, match="other than zero"):
        almath.clipFootWithEllipse(0.0, 0.1, almath.Pose2D())


def test_a_step_without_collision_is_left_alone():
    step = almath.Pose2D(0.0, 0.1, 0.0)
    assert almath.avoidFootCollision(LEFT_FOOT, RIGHT_FOOT, False, step) is False
    assert step == almath.Pose2D(0.0, 0.1, 0.0)


def test_a_step_that_turns_into_the_other_foot_is_turned_less():
    step = almath.Pose2D(0.0, 0.085, 40.0 * almath.TO_RAD)
    assert almath.avoidFootCollision(LEFT_FOOT, RIGHT_FOOT, False, step) is True
    assert step.isNear(almath.Pose2D(0.0, 0.085, 40.0 * almath.TO_RAD * 9 / 32), 1e-12)


def test_the_right_foot_moves_when_the_left_one_stands():
    mirrored = almath.Pose2D(0.0, -0.085, -40.0 * almath.TO_RAD)
    assert almath.avoidFootCollision(LEFT_FOOT, RIGHT_FOOT, True, mirrored) is True
    assert mirrored.theta == pytest.approx(-40.0 * almath.TO_RAD * 9 / 32)


def test_feet_never_overlap_after_a_collision_was_avoided(rng):
    avoided = 0
    for _ in range(300):
        step = almath.Pose2D(rng.uniform(-0.08, 0.08), rng.uniform(0.089, 0.16), rng.uniform(-1.0, 1.0))
        wanted = step.theta
        if almath.avoidFootCollision(LEFT_FOOT, RIGHT_FOOT, False, step):
            avoided += 1
            assert abs(step.theta) < abs(wanted)
        assert not almath.areTwoBoxesInCollision(RIGHT_FOOT, placed(LEFT_FOOT, *step.toVector()))
    assert avoided > 20


def test_a_step_onto_the_other_foot_keeps_no_heading():
    step = almath.Pose2D(0.0, 0.02, 0.3)
    assert almath.avoidFootCollision(LEFT_FOOT, RIGHT_FOOT, False, step) is True
    assert step == almath.Pose2D(0.0, 0.02, 0.0)


def test_corners_may_be_poses_and_any_sequence():
    left, right = ([almath.Pose2D(c.x, c.y, 0.0) for c in box] for box in (LEFT_FOOT, RIGHT_FOOT))
    step, same = almath.Pose2D(0.0, 0.085, 0.7), almath.Pose2D(0.0, 0.085, 0.7)
    almath.avoidFootCollision(almath.vectorPose2D(left), tuple(right), False, step)
    almath.avoidFootCollision(LEFT_FOOT, RIGHT_FOOT, False, same)
    assert step == same
    with pytest.raises(almath.AlmathError, match=r"avoidFootCollision takes a list of Position2D, got \(0, 1\) in it"):
        almath.avoidFootCollision([(0, 1)], right, False, step)


@pytest.mark.parametrize(
    "pose, collides",
    [
        ((0.0, 0.0, 0.0), True),
        ((1.9, 0.0, 0.0), True),
        ((2.0, 0.0, 0.0), True),
        ((2.1, 0.0, 0.0), False),
        ((2.1, 0.0, math.pi / 4), True),
        ((2.1, 2.1, math.pi / 4), False),
        ((-2.5, 0.0, math.pi / 4), False),
    ],
)
def test_squares_collide_where_they_share_a_point(pose, collides):
    other = placed(SQUARE, *pose)
    assert almath.areTwoBoxesInCollision(SQUARE, other) is collides
    assert almath.areTwoBoxesInCollision(other, SQUARE) is collides
    assert almath.areTwoBoxesInCollision(SQUARE[::-1], other) is collides


def test_a_box_inside_another_collides_and_nothing_does_not():
    small = [corner * 0.1 for corner in SQUARE]
    assert almath.areTwoBoxesInCollision(SQUARE, small)
    assert almath.areTwoBoxesInCollision(small, SQUARE)
    assert not almath.areTwoBoxesInCollision(SQUARE, [])


def test_bisection_ends_next_to_the_collision():
    step = almath.Pose2D(2.2, 0.0, math.pi / 4)
    almath.dichotomie(SQUARE, SQUARE, step)
    # The corner of the turned square reaches sqrt(2) cos(pi/4 - angle) from its centre.
    touching = math.pi / 4 - math.acos(1.2 / math.sqrt(2.0))
    assert touching - math.pi / 4 / 32 <= step.theta <= touching


@pytest.mark.parametrize(
    "b_start, b_end, shared",
    [
        ((-1.0, 0.0), (1.0, 0.0), (0.0, 0.0)),
        ((-1.0, 1.0), (1.0, 1.0), (0.0, 1.0)),
        ((-1.0, 1.0001), (1.0, 1.0001), None),
        ((0.5, 0.0), (1.5, 0.0), None),
        ((-1.0, 0.0), (-0.2, 0.0), None),
        ((0.2, 0.0), (1.0, 0.0), None),
        ((-1.0, -1.2), (1.0, -1.2), None),
        ((0.0, 0.0), (0.0, 2.0), None),
        ((-1.0, -1.0), (1.0, 0.5), (0.0, -0.25)),
    ],
)
def test_segments_share_one_point_or_none(b_start, b_end, shared):
    out = almath.Position2D(9.0, 9.0)
    ends = [almath.Position2D(point) for point in ((0.0, -1.0), (0.0, 1.0), b_start, b_end)]
    assert almath.intersectionSegment2D(*ends, out) is (shared is not None)
    assert out.isNear(almath.Position2D(shared or (9.0, 9.0)), 1e-12)
