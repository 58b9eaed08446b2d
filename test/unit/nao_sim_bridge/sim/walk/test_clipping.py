"""What the legs can step: box, ellipse, and feet that do not stand on each other."""

from __future__ import annotations

import math
import random

import pytest

from nao_sim_bridge.sim.walk.clipping import clip_step, feet_overlap, sidestep, spread, step_limits
from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT

LIMITS = step_limits()
SIDES = (LEFT, RIGHT)
ROUNDING = 1e-9


def some_placements(count, seed):
    """Anywhere around the other foot, most of them out of reach."""
    r = random.Random(seed)
    return [FootPose(r.uniform(-0.2, 0.2), r.uniform(-0.3, 0.3), r.uniform(-1.5, 1.5)) for _ in range(count)]


def reach(placement, side):
    """1 on the edge of the ellipse that the legs can step, less inside."""
    longest = LIMITS.max_x if placement.x >= 0.0 else -LIMITS.min_x
    across = (side * placement.y - LIMITS.min_y) / (LIMITS.max_y - LIMITS.min_y)
    return math.hypot(placement.x / longest, across)


def mirrored(placement):
    return FootPose(placement.x, -placement.y, -placement.yaw)


@pytest.mark.parametrize("side", SIDES)
def test_no_clipped_step_is_out_of_reach(side):
    for placement in some_placements(400, seed=1):
        x, y, turn = clipped = clip_step(placement, side, LIMITS)
        assert LIMITS.min_x <= x <= LIMITS.max_x
        assert LIMITS.min_y - ROUNDING <= side * y <= LIMITS.max_y
        assert reach(clipped, side) <= 1.0 + ROUNDING
        assert abs(turn) <= LIMITS.max_turn
        assert not feet_overlap(clipped, side, LIMITS)


@pytest.mark.parametrize("side", SIDES)
def test_a_step_within_reach_stays_as_it_is(side):
    for placement in some_placements(400, seed=2):
        clipped = clip_step(placement, side, LIMITS)
        assert clip_step(clipped, side, LIMITS) == pytest.approx(clipped, abs=0.5 * LIMITS.max_turn / 20)
    for x, y, turn in [(0.0, 0.1, 0.0), (0.04, 0.1, 0.0), (-0.03, 0.11, 0.1), (0.0, 0.15, 0.5)]:
        assert clip_step(FootPose(x, side * y, side * turn), side, LIMITS) == pytest.approx((x, side * y, side * turn))


def test_left_and_right_are_mirror_images():
    for placement in some_placements(200, seed=3):
        left = clip_step(placement, LEFT, LIMITS)
        assert mirrored(clip_step(mirrored(placement), RIGHT, LIMITS)) == pytest.approx(left)


def test_a_foot_does_not_cross_the_other_one():
    assert clip_step(FootPose(0.0, -0.1, 0.0), LEFT, LIMITS).y == pytest.approx(LIMITS.min_y)


def test_a_long_step_ahead_and_aside_keeps_its_proportions():
    x, y, _ = clip_step(FootPose(0.08, 0.16, 0.0), LEFT, LIMITS)
    assert x / LIMITS.max_x == pytest.approx((y - LIMITS.min_y) / (LIMITS.max_y - LIMITS.min_y))
    assert x / LIMITS.max_x == pytest.approx(math.sqrt(0.5))


@pytest.mark.parametrize("side", SIDES)
def test_toes_that_turn_towards_the_other_foot_are_turned_back_only_as_far_as_needed(side):
    inwards = clip_step(FootPose(0.0, side * LIMITS.min_y, -side * 0.5), side, LIMITS)
    assert 0.0 <= -side * inwards.yaw < 0.5
    a_bit_more = inwards._replace(yaw=inwards.yaw - side * 0.5 / 20)
    assert feet_overlap(a_bit_more, side, LIMITS)
    outwards = clip_step(FootPose(0.0, side * LIMITS.min_y, side * 0.5), side, LIMITS)
    assert abs(outwards.yaw) <= 0.5


def test_feet_overlap_where_one_stands_on_the_other():
    for side in SIDES:
        assert feet_overlap(FootPose(0.0, side * 0.05, 0.0), side, LIMITS)
        assert feet_overlap(FootPose(0.02, -side * 0.01, 1.0), side, LIMITS)
        assert not feet_overlap(FootPose(0.0, side * 0.1, 0.0), side, LIMITS)
        assert not feet_overlap(FootPose(0.3, 0.0, 0.0), side, LIMITS)


@pytest.mark.parametrize("share", [0.5, 0.8, 1.0])
def test_two_steps_share_a_turn(share):
    outer, inner = spread(0.2, True, share), spread(0.2, False, share)
    assert outer + inner == pytest.approx(0.4)
    assert outer >= inner >= 0.0


@pytest.mark.parametrize("aside", [-0.026, -0.004, 0.0, 0.004, 0.026])
def test_two_steps_share_the_way_to_the_side(aside):
    outer, inner = sidestep(aside, True, 0.012), sidestep(aside, False, 0.012)
    assert outer + inner == pytest.approx(2.0 * aside)
    assert abs(inner) <= 0.012
    assert outer * aside >= 0.0 and inner * aside >= 0.0
