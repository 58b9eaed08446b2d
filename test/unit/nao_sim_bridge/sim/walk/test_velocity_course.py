"""Walking at a velocity, with steps that are made exactly as planned."""

from __future__ import annotations

import math
import random

import pytest

from nao_sim_bridge.sim.walk.clipping import clip_step, step_limits
from nao_sim_bridge.sim.walk.courses import STANDSTILL, rate_limits
from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.gait import FeetGait, feet_gait
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.settings import load_walk_settings
from nao_sim_bridge.sim.walk.velocity_course import CLOSING_STEPS, VelocityCourse, within

SIDE_BY_SIDE = {1: FootPose(0.0, 0.05, 0.0), -1: FootPose(0.0, -0.05, 0.0)}

SETTINGS = load_walk_settings()
LIMITS = step_limits()
GAIT = FeetGait()
AHEAD, BACK = rate_limits(GAIT, forward=True), rate_limits(GAIT, forward=False)
# Steps after which every velocity is reached.
SPEEDING_UP = 6
ROUNDING = 1e-9
RATES = [
    (0.04, 0.0, 0.0),
    (-0.03, 0.0, 0.0),
    (0.0, 0.026, 0.0),
    (0.0, -0.02, 0.0),
    (0.0, 0.0, 0.3),
    (0.0, 0.0, -0.2),
    (0.02, 0.01, -0.1),
    (-0.01, -0.005, 0.1),
]


def course(rate=(0.04, 0.0, 0.0), gait=GAIT, at=STANDSTILL):
    return VelocityCourse(SETTINGS, gait, rate, at)


def some_rates(count, seed):
    r = random.Random(seed)
    return [(r.uniform(-0.1, 0.1), r.uniform(-0.06, 0.06), r.uniform(-0.8, 0.8)) for _ in range(count)]


def size(rate, gait=GAIT):
    """1 on the edge of what a gait allows."""
    return math.sqrt(sum((part / most) ** 2 for part, most in zip(rate, rate_limits(gait, rate[0] >= 0.0))))


# --- what is asked for --------------------------------------------------------------------------------------------


def test_the_largest_rates_are_those_of_the_documented_gait():
    assert AHEAD == pytest.approx((0.04, 0.026, 0.349))
    assert BACK[0] == pytest.approx(0.04)


def test_larger_steps_are_allowed_by_a_larger_gait():
    gait = feet_gait({"MaxStepX": 0.08, "MaxStepY": 0.16, "MaxStepTheta": 0.5})
    assert rate_limits(gait, forward=True) == pytest.approx((0.08, 0.036, 0.5))
    assert rate_limits(gait, forward=False)[0] == pytest.approx(0.04), "the step back has no parameter"


@pytest.mark.parametrize("seed", range(5))
def test_together_the_parts_of_a_rate_stay_in_the_ellipsoid(seed):
    for rate in some_rates(40, seed):
        allowed = within(rate, GAIT)
        assert size(allowed) <= 1.0 + ROUNDING
        if size(rate) <= 1.0:
            assert allowed == rate
        else:
            assert allowed == pytest.approx([part / size(rate) for part in rate]), "its direction has changed"


def test_each_part_alone_may_be_as_large_as_its_limit():
    for rate in [(AHEAD[0], 0.0, 0.0), (-BACK[0], 0.0, 0.0), (0.0, -AHEAD[1], 0.0), (0.0, 0.0, AHEAD[2])]:
        assert course(rate).wanted == pytest.approx(rate)


# --- the steps ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", RATES)
def test_two_steps_go_twice_the_way_of_one(walked, rate):
    one = course(rate)
    before, _, after = walked(one, SPEEDING_UP)[-3:]
    x, y, yaw = after.robot.seen_from(before.robot)
    assert yaw == pytest.approx(2.0 * rate[2], abs=1e-3)
    # Of a turn each foot makes a share of its own, about a middle of its own: a few mm of the way come from that.
    way = math.hypot(x, y)
    assert way == pytest.approx(2.0 * math.hypot(rate[0], rate[1]), abs=1e-4 if rate[2] == 0.0 else 4e-3)


@pytest.mark.parametrize("seed", range(8))
def test_rates_change_by_no_more_than_a_step_can(walked, seed):
    first, second = some_rates(2, seed)
    one = course(first)
    rates, after = [STANDSTILL], None
    for target in (first, second, STANDSTILL):
        one = course(target, at=one.rate)
        for _ in range(SPEEDING_UP):
            after = walked(one, 1, after)[0]
            rates.append(one.rate)
    for before, now in zip(rates, rates[1:]):
        assert all(abs(b - a) <= most + ROUNDING for a, b, most in zip(before, now, SETTINGS.change))


@pytest.mark.parametrize("rate", RATES)
def test_a_rate_is_reached_and_held(walked, rate):
    one = course(rate)
    walked(one, SPEEDING_UP)
    assert one.rate == pytest.approx(rate)
    walked(one, 5)
    assert one.rate == pytest.approx(rate)


@pytest.mark.parametrize("seed", range(10))
def test_no_step_is_larger_than_the_legs_can(walked, seed):
    last, at = None, STANDSTILL
    for rate in some_rates(4, seed):
        one = course(rate, at=at)
        for made in walked(one, 7, last):
            assert clip_step(made.placement, made.step.side, LIMITS) == pytest.approx(made.placement)
            last = made
        at = one.rate


def test_a_sidestep_is_made_by_the_outer_foot(walked):
    outer, inner = walked(course((0.0, 0.02, 0.0)), SPEEDING_UP)[-2:]
    assert (outer.step.side, inner.step.side) == (LEFT, RIGHT)
    assert outer.placement.y == pytest.approx(0.1 + 0.028)
    assert -inner.placement.y == pytest.approx(SETTINGS.min_foot_separation)


def test_of_a_turn_the_outer_foot_makes_its_share(walked):
    outer, inner = walked(course((0.0, 0.0, -0.2)), SPEEDING_UP)[-2:]
    assert (outer.step.side, inner.step.side) == (RIGHT, LEFT)
    assert outer.placement.yaw == pytest.approx(-0.4 * SETTINGS.outer_turn)
    assert inner.placement.yaw == pytest.approx(-0.4 * (1.0 - SETTINGS.outer_turn))


@pytest.mark.parametrize("rate", [rate for rate in RATES if rate[1] or rate[2]])
def test_left_and_right_are_mirror_images(walked, rate):
    mirrored = (rate[0], -rate[1], -rate[2])
    for one, other in zip(walked(course(rate), 8), walked(course(mirrored), 8)):
        assert other.step.side == -one.step.side
        x, y, yaw = one.step.landing
        assert other.step.landing == pytest.approx((x, -y, -yaw))


@pytest.mark.parametrize(
    "rate, side",
    [
        ((0.04, 0.0, 0.0), LEFT),
        ((0.0, 0.02, 0.0), LEFT),
        ((0.0, -0.02, 0.0), RIGHT),
        ((0.0, 0.0, 0.2), LEFT),
        ((0.04, 0.0, -0.2), RIGHT),
        ((0.0, 0.01, -0.2), LEFT),
    ],
)
def test_the_foot_on_the_side_where_it_goes_moves_first(rate, side):
    assert course(rate).first_side(SIDE_BY_SIDE) == side


def test_each_foot_steps_at_its_own_gait(walked):
    gait = feet_gait({"LeftMaxStepX": 0.06, "RightMaxStepX": 0.02, "LeftStepHeight": 0.03, "LeftMaxStepFrequency": 0.0})
    left, right = walked(course((0.04, 0.0, 0.0), gait), SPEEDING_UP)[-2:]
    assert (left.placement.x, right.placement.x) == pytest.approx((0.06, 0.02))
    assert (left.step.gait.step_height, right.step.gait.step_height) == (0.03, 0.02)
    assert (left.step.period, right.step.period) == pytest.approx((0.6, 0.42))


def test_looking_ahead_changes_nothing_and_tells_what_will_be(walked, feet_at):
    one = course((0.03, 0.01, 0.1))
    feet = feet_at()
    ahead = one.upcoming(feet[RIGHT], LEFT, 5)
    assert one.upcoming(feet[RIGHT], LEFT, 5) == ahead
    assert [made.step for made in walked(one, 5)] == ahead


# --- the end ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("count", range(7))
def test_told_to_end_it_closes_the_feet_and_is_over(walked, rate, count):
    one = course(rate)
    made = walked(one, count)
    one.end()
    last = walked(one, after=made[-1] if made else None)
    assert len(last) == CLOSING_STEPS, "at the default speed it need not slow down first"
    assert last[-1].placement == pytest.approx((0.0, -0.1 if last[-1].step.side == RIGHT else 0.1, 0.0))
    assert one.upcoming(last[-1].step.landing, -last[-1].step.side, 3) == []
    assert one.rate == STANDSTILL


def test_at_long_steps_it_slows_down_first(walked):
    one = course((0.08, 0.0, 0.0), feet_gait({"MaxStepX": 0.08}))
    made = walked(one, 10)
    one.end()
    last = walked(one, after=made[-1])
    assert CLOSING_STEPS < len(last) <= 5
    ways = [m.robot.x - b.robot.x for b, m in zip([made[-1], *last], last)]
    assert ways == sorted(ways, reverse=True)


def test_it_goes_on_for_ever_unless_told_to_end(walked):
    assert len(walked(course(), 300)) == 300


# --- what it makes up for -----------------------------------------------------------------------------------------


def turned_by(one, walked, turn, steps):
    """Headings in the world after the robot, walking, was turned by somebody, rad."""
    begun = walked(one, SPEEDING_UP)[-1]
    before = one.frame.moved(*begun.robot).yaw
    one.frame = one.frame.moved(*begun.robot).moved(0.0, 0.0, turn)
    one.frame = one.frame.moved(*FootPose(0.0, 0.0, 0.0).seen_from(begun.robot))
    made = walked(one, steps, after=begun)
    return before, [one.frame.moved(*m.robot).yaw for m in made]


@pytest.mark.parametrize("turn", [-0.2, 0.15])
def test_a_robot_that_was_turned_goes_back_to_its_heading(walked, turn):
    before, headings = turned_by(course(), walked, turn, 30)
    assert headings[-1] == pytest.approx(before, abs=5e-3)
    for last, now in zip([before + turn, *headings], headings):
        assert abs(now - last) <= SETTINGS.turn_hold_limit + ROUNDING


def test_a_robot_that_was_turned_round_does_not_turn_all_the_way_back(walked):
    before, headings = turned_by(course(), walked, 2.0, 60)
    assert headings[-1] == pytest.approx(before + 1.5, abs=0.02)


@pytest.mark.parametrize("aside, made_up_for", [(0.03, 0.03), (-0.03, -0.03), (0.2, 0.05)])
def test_a_robot_that_was_pushed_aside_comes_back_to_its_line(walked, aside, made_up_for):
    one = course()
    begun = walked(one, SPEEDING_UP)[-1]
    one.frame = one.frame.moved(0.0, aside)
    last = walked(one, 40, after=begun)[-1]
    assert one.frame.moved(*last.robot).y == pytest.approx(aside - made_up_for, abs=3e-3)


@pytest.mark.parametrize("ahead", [-0.1, 0.1])
def test_a_robot_that_was_pushed_along_its_way_just_goes_on(walked, ahead):
    one, other = course(), course()
    begun, begun_other = walked(one, SPEEDING_UP)[-1], walked(other, SPEEDING_UP)[-1]
    one.frame = one.frame.moved(ahead, 0.0)
    made, made_other = walked(one, 6, after=begun), walked(other, 6, after=begun_other)
    assert [m.step for m in made] == [m.step for m in made_other]
