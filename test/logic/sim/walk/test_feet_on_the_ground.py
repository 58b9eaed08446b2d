"""Poses of feet, what legs can step, the way of a foot through the air."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim_bridge.walk.body import frame_from
from nao_sim_bridge.walk.clipping import clip_step, feet_overlap, step_limits
from nao_sim_bridge.walk.footsteps import FootPose, middle, swing
from nao_sim_bridge.walk.legs import LEFT, RIGHT

LIMITS = step_limits()
ROUNDING = 1e-9
sides = st.sampled_from((LEFT, RIGHT))
poses = st.builds(FootPose, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(-3.1, 3.1))
placements = st.builds(FootPose, st.floats(-0.2, 0.2), st.floats(-0.3, 0.3), st.floats(-1.5, 1.5))
"""Anywhere around the other foot, most of them out of reach."""


def test_a_move_is_in_the_own_frame():
    assert FootPose(1.0, 2.0, math.pi / 2).moved(0.5, 0.1, 0.2) == pytest.approx((0.9, 2.5, math.pi / 2 + 0.2))


def test_turns_go_the_short_way():
    assert FootPose(0.0, 0.0, 3.0).seen_from(FootPose(0.0, 0.0, -3.0)).yaw == pytest.approx(6.0 - 2 * math.pi)
    x, y, yaw = middle(FootPose(0.0, 0.05, 3.1), FootPose(0.1, -0.05, -3.1))
    assert (x, y, abs(yaw)) == pytest.approx((0.05, 0.0, math.pi))


@given(poses, poses)
def test_a_frame_has_things_where_they_were_seen_and_is_found_again_by_what_stands_in_it(there, here):
    frame = frame_from(there, here)
    back, again = frame.moved(*here), frame_from(frame.moved(*here), here)
    for one, other in ((back, there), (again, frame)):
        assert one[:2] == pytest.approx(other[:2], abs=ROUNDING)
        assert math.cos(one.yaw - other.yaw) == pytest.approx(1.0)


@given(placements, sides)
def test_a_clipped_step_is_in_reach_mirrored_by_the_other_leg_and_stays_as_it_is(placement, side):
    x, y, turn = clipped = clip_step(placement, side, LIMITS)
    assert LIMITS.min_x <= x <= LIMITS.max_x
    assert LIMITS.min_y - ROUNDING <= side * y <= LIMITS.max_y
    across = (side * y - LIMITS.min_y) / (LIMITS.max_y - LIMITS.min_y)
    assert math.hypot(x / (LIMITS.max_x if x >= 0.0 else -LIMITS.min_x), across) <= 1.0 + ROUNDING
    assert abs(turn) <= LIMITS.max_turn
    assert not feet_overlap(clipped, side, LIMITS)
    mirrored = clip_step(FootPose(placement.x, -placement.y, -placement.yaw), -side, LIMITS)
    assert (mirrored.x, -mirrored.y, -mirrored.yaw) == pytest.approx(clipped)
    assert clip_step(clipped, side, LIMITS) == pytest.approx(clipped, abs=0.5 * LIMITS.max_turn / 20)


@pytest.mark.parametrize("x, y, turn", [(0.04, 0.1, 0), (-0.03, 0.11, 0.1), (0, 0.15, 0.5)])
@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_what_legs_can_step_is_not_clipped(x, y, turn, side):
    assert clip_step(FootPose(x, side * y, side * turn), side, LIMITS) == pytest.approx((x, side * y, side * turn))


def test_a_long_step_ahead_and_aside_keeps_its_proportions():
    x, y, _ = clip_step(FootPose(0.08, 0.16, 0.0), LEFT, LIMITS)
    assert x / LIMITS.max_x == pytest.approx(math.sqrt(0.5))
    assert (y - LIMITS.min_y) / (LIMITS.max_y - LIMITS.min_y) == pytest.approx(math.sqrt(0.5))


@pytest.mark.parametrize("x, y, yaw, over", [(0, 0.05, 0, 1), (0.02, -0.01, 1, 1), (0, 0.1, 0, 0), (0.3, 0, 0, 0)])
@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_feet_overlap_where_one_stands_on_the_other(x, y, yaw, over, side):
    assert feet_overlap(FootPose(x, side * y, yaw), side, LIMITS) == bool(over)


START, END, LIFT = FootPose(0.0, 0.1, 3.0), FootPose(0.08, 0.12, -3.0), 0.025


def test_a_foot_swings_forward_and_up_turns_the_short_way_and_rests_at_both_ends():
    way = [swing(START, END, i / 200, LIFT) for i in range(201)]
    assert way[0] == (START, 0.0)
    assert way[-1].pose[:2] == pytest.approx(END[:2])
    assert way[100].pose[:2] == pytest.approx((0.04, 0.11))
    xs, yaws, heights = [at.pose.x for at in way], [at.pose.yaw for at in way], [at.height for at in way]
    assert xs == sorted(xs) and yaws == sorted(yaws)
    assert yaws[-1] - yaws[0] == pytest.approx(2 * math.pi - 6.0)
    assert heights[100] == max(heights) == pytest.approx(LIFT)
    assert min(heights) == 0.0 and heights[-1] == pytest.approx(0.0)
    steps = [b - a for a, b in zip(xs, xs[1:])]
    assert max(steps[0], steps[-1]) < 1e-3 * max(steps)
    assert max(heights[1], heights[-2]) < 1e-3 * LIFT
    assert swing(START, END, -0.5, LIFT) == way[0] and swing(START, END, 1.5, LIFT) == way[-1]
