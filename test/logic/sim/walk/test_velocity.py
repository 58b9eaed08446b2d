"""Walking at a velocity, with steps that are made exactly as planned."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim_bridge.walk.clipping import clip_step, step_limits
from nao_sim_bridge.walk.courses import STANDSTILL, rate_limits
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait, feet_gait
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.settings import load_walk_settings
from nao_sim_bridge.walk.velocity_course import CLOSING_STEPS, VelocityCourse, within

SETTINGS = load_walk_settings()
LIMITS = step_limits()
GAIT = FeetGait()
AHEAD, BACK = rate_limits(GAIT, forward=True), rate_limits(GAIT, forward=False)
# Steps after which every velocity is reached.
SPEEDING_UP = 6
ROUNDING = 1e-9
STRAIGHT = [(0.04, 0.0, 0.0), (-0.03, 0.0, 0.0), (0.0, 0.026, 0.0), (0.0, -0.02, 0.0)]
TURNING = [(0.0, 0.0, 0.3), (0.0, 0.0, -0.2), (0.02, 0.01, -0.1), (-0.01, -0.005, 0.1)]
any_rate = st.tuples(st.floats(-0.1, 0.1), st.floats(-0.06, 0.06), st.floats(-0.8, 0.8))


def course(rate=(0.04, 0.0, 0.0), gait=GAIT, at=STANDSTILL):
    return VelocityCourse(SETTINGS, gait, rate, at)


def test_the_largest_rates_are_those_of_the_gait():
    assert AHEAD == pytest.approx((0.04, 0.026, 0.349))
    assert BACK[0] == pytest.approx(0.04)
    gait = feet_gait({"MaxStepX": 0.08, "MaxStepY": 0.16, "MaxStepTheta": 0.5})
    assert rate_limits(gait, forward=True) == pytest.approx((0.08, 0.036, 0.5))
    assert rate_limits(gait, forward=False)[0] == pytest.approx(0.04), "the step back has no parameter"


@given(any_rate)
def test_together_the_parts_of_a_rate_stay_in_the_ellipsoid(rate):
    limits = rate_limits(GAIT, rate[0] >= 0.0)
    size = math.sqrt(sum((part / most) ** 2 for part, most in zip(rate, limits)))
    assert within(rate, GAIT) == (rate if size <= 1.0 else pytest.approx([part / size for part in rate]))


@pytest.mark.parametrize("rate", STRAIGHT + TURNING)
def test_a_rate_is_reached_and_held_and_two_steps_go_twice_the_way_of_one(walked, rate):
    one = course(rate)
    before, _, after = walked(one, SPEEDING_UP)[-3:]
    assert one.rate == pytest.approx(rate)
    x, y, yaw = after.robot.seen_from(before.robot)
    assert yaw == pytest.approx(2.0 * rate[2], abs=1e-3)
    # Of a turn each foot makes a share of its own, about a middle of its own: a few mm of the way come from that.
    way = 2.0 * math.hypot(rate[0], rate[1])
    assert math.hypot(x, y) == pytest.approx(way, abs=1e-4 if rate in STRAIGHT else 4e-3)
    walked(one, 5)
    assert one.rate == pytest.approx(rate)


@given(st.lists(any_rate, min_size=3, max_size=3))
@settings(max_examples=30)
def test_rates_change_by_no_more_than_a_step_can_and_no_step_is_larger_than_legs_can(walked, rates):
    at, after = STANDSTILL, None
    for wanted in (*rates, STANDSTILL):
        one = course(wanted, at=at)
        for _ in range(SPEEDING_UP):
            (after,) = walked(one, 1, after)
            assert all(abs(b - a) <= most + ROUNDING for a, b, most in zip(at, one.rate, SETTINGS.change))
            assert clip_step(after.placement, after.step.side, LIMITS) == pytest.approx(after.placement)
            at = one.rate


def test_of_a_turn_the_outer_foot_makes_its_share(walked):
    outer, inner = walked(course((0.0, 0.0, -0.2)), SPEEDING_UP)[-2:]
    assert (outer.step.side, inner.step.side) == (RIGHT, LEFT)
    assert outer.placement.yaw == pytest.approx(-0.4 * SETTINGS.outer_turn)
    assert inner.placement.yaw == pytest.approx(-0.4 * (1.0 - SETTINGS.outer_turn))


@pytest.mark.parametrize("rate", [(0.0, 0.026, 0.0), *TURNING])
def test_left_and_right_are_mirror_images_of_a_walk_at_a_velocity(walked, rate):
    mirrored = (rate[0], -rate[1], -rate[2])
    for one, other in zip(walked(course(rate), 8), walked(course(mirrored), 8)):
        assert other.step.side == -one.step.side
        x, y, yaw = one.step.landing
        assert other.step.landing == pytest.approx((x, -y, -yaw))


@pytest.mark.parametrize(
    "rate, side",
    [((4, 0, 0), 1), ((0, 2, 0), 1), ((0, -2, 0), -1), ((0, 0, 20), 1), ((4, 0, -20), -1), ((0, 1, -20), 1)],
)
def test_the_foot_on_the_side_where_it_goes_moves_first(feet_at, rate, side):
    assert course([part / 100 for part in rate]).first_side(feet_at()) == side


def test_each_foot_steps_at_its_own_gait(walked):
    gait = feet_gait({"LeftMaxStepX": 0.06, "RightMaxStepX": 0.02, "LeftStepHeight": 0.03, "LeftMaxStepFrequency": 0.0})
    left, right = walked(course((0.04, 0.0, 0.0), gait), SPEEDING_UP)[-2:]
    assert (left.placement.x, right.placement.x) == pytest.approx((0.06, 0.02))
    assert (left.step.gait.step_height, right.step.gait.step_height) == (0.03, 0.02)
    assert (left.step.period, right.step.period) == pytest.approx((0.6, 0.42))


@pytest.mark.parametrize("rate", STRAIGHT + TURNING)
def test_told_to_end_it_closes_the_feet_and_is_over(walked, rate):
    for count in range(7):
        one = course(rate)
        made = walked(one, count)
        one.end()
        last = walked(one, after=made[-1] if made else None)
        assert len(last) == CLOSING_STEPS, "at the default speed it need not slow down first"
        assert last[-1].placement == pytest.approx((0.0, 0.1 * last[-1].step.side, 0.0))
        assert one.upcoming(last[-1].step.landing, -last[-1].step.side, 3) == []
        assert one.rate == STANDSTILL


@pytest.mark.parametrize("turn, made_up_for", [(-0.2, -0.2), (0.15, 0.15), (2.0, 0.5)])
def test_a_robot_that_was_turned_goes_back_to_its_heading_but_not_all_the_way_round(walked, turn, made_up_for):
    one = course()
    begun = walked(one, SPEEDING_UP)[-1]
    before = one.frame.moved(*begun.robot).yaw
    one.frame = one.frame.moved(*begun.robot).moved(0.0, 0.0, turn)
    one.frame = one.frame.moved(*FootPose(0.0, 0.0, 0.0).seen_from(begun.robot))
    headings = [before + turn, *(one.frame.moved(*m.robot).yaw for m in walked(one, 60, after=begun))]
    assert headings[-1] == pytest.approx(before + turn - made_up_for, abs=0.02)
    assert all(abs(b - a) <= SETTINGS.turn_hold_limit + ROUNDING for a, b in zip(headings, headings[1:]))
