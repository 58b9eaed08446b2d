"""Walks to a place and walks of planned steps, with steps that are made exactly as planned."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.walk.clipping import clip_step, step_limits
from nao_sim_bridge.walk.courses import STANDSTILL, rate_limits
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait, feet_gait
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.settings import load_walk_settings
from nao_sim_bridge.walk.steps_course import Placement, StepsCourse
from nao_sim_bridge.walk.target_course import ARRIVED, ARRIVED_TURN, TargetCourse, braking

SETTINGS = load_walk_settings()
GAIT = FeetGait()
LIMITS = step_limits()
ROUNDING = 1e-9
places = st.builds(FootPose, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-3.1, 3.1))


def course(*goals, gait=GAIT, steps=1, rate=STANDSTILL, start=None):
    one = TargetCourse(SETTINGS, gait, [FootPose(*goal) for goal in goals], steps, rate)
    one.begin_towards(start or FootPose(0.0, 0.0, 0.0))
    return one


def off(goal, robot):
    x, y, yaw = FootPose(*goal).seen_from(robot)
    return math.hypot(x, y), abs(yaw)


def arrived(goal, robot):
    distance, turn = off(goal, robot)
    return distance < ARRIVED and turn < ARRIVED_TURN


def least_steps(goal):
    """Steps that the way takes at full speed; distance and turn are made together."""
    x, y, yaw = goal
    longest, aside, turn = rate_limits(GAIT, x >= 0.0)
    return math.sqrt((x / longest) ** 2 + (y / aside) ** 2 + (yaw / turn) ** 2)


@given(start=places, goal=places)
@settings(max_examples=40)
def test_from_everywhere_it_arrives_with_steps_that_legs_can_make_coming_closer_all_the_time(
    walked, feet_at, start, goal
):
    one, after, made, rates = course(goal, start=start), None, [], [STANDSTILL]
    while not one.reached:
        (after,) = walked(one, 1, after, feet_at(*start))
        made.append(after)
        rates.append(one.rate)
        assert clip_step(after.placement, after.step.side, LIMITS) == pytest.approx(after.placement)
    assert arrived(goal, after.robot)
    # Both feet stand beside each other, up to what counts as arrived.
    assert after.placement == pytest.approx((0.0, after.step.side * 0.1, 0.0), abs=1.5 * ARRIVED_TURN)
    # One step alone may be the smaller half of a sidestep or of a turn, two are not; a way that turns is longer.
    left_to_go = [least_steps(goal.seen_from(m.robot)) for m in made]
    assert all(now < before + 1e-6 for before, now in zip(left_to_go, left_to_go[2:]))
    for before, now in zip(rates, rates[1:-1]):
        assert all(abs(b - a) <= most + ROUNDING for a, b, most in zip(before, now, SETTINGS.change))


@pytest.mark.parametrize("goal, side", [((1.0, 0.0, 0.0), LEFT), ((1.0, -0.1, 0.0), RIGHT), ((0.0, 0.0, -1.0), RIGHT)])
def test_the_foot_on_the_side_of_the_goal_moves_first(feet_at, goal, side):
    assert course(goal).first_side(feet_at()) == side


@pytest.mark.parametrize("change, distance", [(0.01, 0.0), (0.01, 0.5), (0.12, 0.05), (0.12, 2.0)])
def test_braking_comes_to_rest_just_at_the_end(change, distance):
    """Of the last steps one may be harder by an eighth: they are whole ones."""
    left, rate = distance, math.inf
    for _ in range(1000):
        rate = min(braking(left, change), rate)
        assert rate <= left + ROUNDING
        if left - rate > ROUNDING:
            assert braking(left - rate, change) >= rate - 1.13 * change - 1e-6, "it cannot slow down that fast"
        left -= rate
    assert left == pytest.approx(0.0, abs=1e-6)


def step(side, x=0.04, y=None, yaw=0.0, period=0.5):
    return Placement(side, FootPose(x, side * 0.1 if y is None else y, yaw), period)


def planned(*steps, gait=None):
    return StepsCourse(SETTINGS, gait or FeetGait(), steps)


PLAN = [step(LEFT), step(RIGHT, 0.02, -0.12, -0.2), step(LEFT, 0.0, 0.1, 0.0, 0.55), step(RIGHT, 0.0)]


def test_it_makes_exactly_the_steps_of_the_plan_and_is_over_after_the_last_one(walked):
    one = planned(*PLAN)
    made = walked(one, len(PLAN) - 1)
    assert not one.reached and one.left == (PLAN[-1],)
    made += walked(one, after=made[-1])
    assert one.reached and one.left == ()
    assert [m.step.side for m in made] == [s.side for s in PLAN]
    assert [m.placement for m in made] == [pytest.approx(s.beside) for s in PLAN]
    assert [m.step.period for m in made] == pytest.approx([s.period for s in PLAN])


def test_what_legs_cannot_step_is_clipped_and_no_step_is_too_quick(walked):
    far = step(LEFT, 0.3, 0.3, 1.0)
    (made,) = walked(planned(far))
    assert made.placement == pytest.approx(clip_step(far.beside, LEFT, LIMITS))
    (made,) = walked(planned(step(LEFT, period=0.1)))
    assert made.step.period == pytest.approx(0.42)
    (made,) = walked(planned(step(LEFT, period=0.1), gait=feet_gait({"MaxStepFrequency": 0.0})))
    assert made.step.period == pytest.approx(0.6)


def test_between_two_steps_of_one_foot_the_other_one_comes_beside_it(walked):
    made = walked(planned(step(LEFT), step(LEFT), step(RIGHT, 0.0)))
    assert [m.step.side for m in made] == [LEFT, RIGHT, LEFT, RIGHT]
    assert made[1].placement == pytest.approx((0.0, -0.1, 0.0))
    assert made[2].placement == pytest.approx((0.04, 0.1, 0.0))
    assert made[2].robot.x == pytest.approx(0.06)


def test_steps_can_be_added_or_take_the_place_of_those_to_come(walked):
    one = planned(*PLAN[:2])
    made = walked(one, 1)
    one.add(PLAN[2:], clear=False)
    assert one.left == tuple(PLAN[1:])
    made += walked(one, 1, after=made[-1])
    back = step(LEFT, -0.03)
    one.add([back], clear=True)
    assert [m.placement for m in walked(one, after=made[-1])] == [pytest.approx(back.beside)]
    assert walked(planned()) == []
    one = planned(*PLAN)
    made = walked(one, 2)
    one.add([], clear=True)
    assert walked(one, after=made[-1]) == []


def test_steps_that_are_left_have_a_bound_and_those_that_are_made_do_not_count(walked):
    one = planned(*PLAN)
    made = walked(one, 2)
    one.add([step(LEFT)] * 998, clear=False)
    with pytest.raises(BadValue, match="footSteps is '1001 steps', allowed is 1000 steps at most"):
        one.add([step(LEFT)], clear=False)
    assert len(one.left) == 1000
    one.add([step(LEFT)], clear=True)
    assert len(walked(one, after=made[-1])) == 1
