"""Walking to a place, with steps that are made exactly as planned."""

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
from nao_sim_bridge.sim.walk.target_course import ARRIVED, ARRIVED_TURN, TargetCourse, braking

SIDE_BY_SIDE = {1: FootPose(0.0, 0.05, 0.0), -1: FootPose(0.0, -0.05, 0.0)}

SETTINGS = load_walk_settings()
GAIT = FeetGait()
LIMITS = step_limits()
ROUNDING = 1e-9


def course(*goals, gait=GAIT, steps=1, rate=STANDSTILL, start=None):
    one = TargetCourse(SETTINGS, gait, [FootPose(*goal) for goal in goals], steps, rate)
    one.begin_towards(start or FootPose(0.0, 0.0, 0.0))
    return one


def some_places(count, seed, far=1.0):
    r = random.Random(seed)
    return [FootPose(r.uniform(-far, far), r.uniform(-far, far), r.uniform(-math.pi, math.pi)) for _ in range(count)]


def off(goal, robot):
    x, y, yaw = goal.seen_from(robot)
    return math.hypot(x, y), abs(yaw)


def least_steps(goal):
    """Steps that the way takes at full speed; distance and turn are made together."""
    x, y, yaw = goal
    longest, aside, turn = rate_limits(GAIT, x >= 0.0)
    return math.sqrt((x / longest) ** 2 + (y / aside) ** 2 + (yaw / turn) ** 2)


@pytest.mark.parametrize("seed", range(30))
def test_it_arrives_from_everywhere(walked, feet_at, seed):
    start, goal = some_places(2, seed)
    one = course(goal, start=start)
    made = walked(one, feet=feet_at(*start))
    assert one.reached
    distance, turn = off(goal, made[-1].robot)
    assert distance < ARRIVED and turn < ARRIVED_TURN
    # Both feet stand beside each other, up to what counts as arrived.
    assert made[-1].placement == pytest.approx((0.0, made[-1].step.side * 0.1, 0.0), abs=1.5 * ARRIVED_TURN)


@pytest.mark.parametrize("seed", range(30))
def test_it_comes_closer_all_the_time(walked, feet_at, seed):
    start, goal = some_places(2, seed)
    left_to_go = [
        least_steps(goal.seen_from(made.robot)) for made in walked(course(goal, start=start), feet=feet_at(*start))
    ]
    # One step alone may be the smaller half of a sidestep or of a turn, two are not; a way that turns is longer.
    for before, now in zip(left_to_go, left_to_go[2:]):
        assert now < before + 1e-6


@pytest.mark.parametrize("seed", range(30))
def test_no_step_is_larger_than_the_legs_can(walked, feet_at, seed):
    start, goal = some_places(2, seed)
    for made in walked(course(goal, start=start), feet=feet_at(*start)):
        assert clip_step(made.placement, made.step.side, LIMITS) == pytest.approx(made.placement)


@pytest.mark.parametrize("seed", range(10))
def test_rates_change_by_no_more_than_a_step_can(walked, feet_at, seed):
    start, goal = some_places(2, seed)
    one = course(goal, start=start)
    rates, after = [STANDSTILL], None
    while not one.reached:
        after = walked(one, 1, after, feet_at(*start))[0]
        rates.append(one.rate)
    for before, now in zip(rates, rates[1:-1]):
        assert all(abs(b - a) <= most + ROUNDING for a, b, most in zip(before, now, SETTINGS.change))


@pytest.mark.parametrize("goal, slower", [((1.0, 0.0, 0.0), 5), ((0.0, 0.4, 0.0), 5), ((0.0, 0.0, 1.5), 5)])
def test_it_takes_hardly_longer_than_it_must(walked, goal, slower):
    assert least_steps(goal) <= len(walked(course(goal))) + 1 <= least_steps(goal) + slower + 2


@pytest.mark.parametrize("steps", [20, 40])
def test_it_takes_its_time_when_it_has_time(walked, steps):
    made = walked(course((0.2, 0.05, 0.3), steps=steps))
    assert steps <= len(made) <= steps + 4


def test_where_it_is_already_it_makes_one_step(walked):
    one = course((0.0, 0.0, 0.0))
    assert len(walked(one)) == 1
    assert one.reached


def test_it_has_not_reached_anything_before_its_last_step_is_begun(walked):
    one = course((0.2, 0.0, 0.0))
    total = len(walked(course((0.2, 0.0, 0.0))))
    made = walked(one, total - 1)
    assert not one.reached
    walked(one, after=made[-1])
    assert one.reached


@pytest.mark.parametrize("seed", range(12))
def test_it_goes_through_the_points_before_the_last_one(walked, seed):
    r = random.Random(seed)
    points, here = [], FootPose(0.0, 0.0, 0.0)
    for _ in range(3):
        here = here.moved(r.uniform(-0.3, 0.3), r.uniform(-0.3, 0.3), r.uniform(-1.0, 1.0))
        points.append(here)
    one = course(*points)
    made = walked(one)
    assert one.reached
    robots = [m.robot for m in made]
    passed = []
    for point in points[:-1]:
        # Two steps before a point it may begin to go to the next one.
        near = [i for i, robot in enumerate(robots) if off(point, robot)[0] < 0.06 and off(point, robot)[1] < 0.7]
        assert near, f"{point} was missed"
        passed.append(near[0])
    assert passed == sorted(passed)
    assert off(points[-1], robots[-1])[0] < ARRIVED


@pytest.mark.parametrize(
    "points",
    [
        [(0.1, 0.0, 0.0), (0.15, 0.05, 0.3)],
        [(0.1, 0.1, 0.5), (0.1, 0.1, 0.5), (0.0, 0.0, 0.0)],
        [(0.0, 0.0, 0.0), (0.1, 0.0, 0.0)],
    ],
)
@pytest.mark.parametrize("seed", range(3))
def test_no_point_on_the_way_is_the_end(walked, points, seed):
    """Feet that are never put exactly where they should be do not keep it from going on to the next point."""
    r = random.Random(seed)
    one = course(*points)
    made, count = None, 0
    while not one.reached:
        made = walked(one, 1, after=made)[0]
        one.frame = FootPose(r.uniform(-0.003, 0.003), r.uniform(-0.003, 0.003), r.uniform(-0.005, 0.005))
        count += 1
        assert count < 50
    assert off(FootPose(*points[-1]), made.robot)[0] < 2.0 * ARRIVED


@pytest.mark.parametrize("goal", [(0.4, 0.2, 0.5), (0.0, -0.3, 0.0), (0.1, 0.0, -1.0)])
def test_left_and_right_are_mirror_images(walked, goal):
    mirrored = (goal[0], -goal[1], -goal[2])
    one, other = walked(course(goal)), walked(course(mirrored))
    assert len(one) == len(other)
    for a, b in zip(one, other):
        x, y, yaw = a.step.landing
        assert b.step.side == -a.step.side
        assert b.step.landing == pytest.approx((x, -y, -yaw))


def test_a_robot_that_was_moved_on_the_way_still_arrives(walked):
    one = course((0.6, 0.0, 0.0))
    made = walked(one, 5)
    one.frame = FootPose(0.02, -0.04, 0.15)
    last = walked(one, after=made[-1])[-1]
    distance, turn = off(FootPose(0.6, 0.0, 0.0), one.frame.moved(*last.robot))
    assert distance < ARRIVED and turn < ARRIVED_TURN


@pytest.mark.parametrize("rate", [(0.04, 0.0, 0.0), (-0.03, 0.0, 0.1), (0.0, 0.02, -0.2)])
def test_a_walking_robot_turns_to_a_goal_without_a_jerk(walked, rate):
    one = course((-0.1, -0.1, 0.0), rate=rate)
    walked(one, 1)
    assert all(abs(b - a) <= most + ROUNDING for a, b, most in zip(rate, one.rate, SETTINGS.change))
    last = course((-0.1, -0.1, 0.0), rate=rate)
    assert off(FootPose(-0.1, -0.1, 0.0), walked(last)[-1].robot)[0] < ARRIVED


@pytest.mark.parametrize("goal, side", [((1.0, 0.0, 0.0), LEFT), ((1.0, -0.1, 0.0), RIGHT), ((0.0, 0.0, -1.0), RIGHT)])
def test_the_foot_on_the_side_of_the_goal_moves_first(goal, side):
    assert course(goal).first_side(SIDE_BY_SIDE) == side


def test_long_steps_get_there_in_fewer(walked):
    far = (1.0, 0.0, 0.0)
    wide = feet_gait({"MaxStepX": 0.08})
    assert len(walked(course(far, gait=wide))) < 0.75 * len(walked(course(far)))


@pytest.mark.parametrize("change", [0.01, 0.12])
@pytest.mark.parametrize("distance", [0.0, 0.005, 0.05, 0.5, 2.0])
def test_braking_comes_to_rest_just_at_the_end(change, distance):
    """Of the last steps one may be harder by an eighth: they are whole ones."""
    left, rate = distance, math.inf
    for _ in range(1000):
        rate = min(braking(left, change), rate)
        assert rate <= left + ROUNDING
        if left - rate > ROUNDING:
            assert braking(left - rate, change) >= rate - 1.13 * change - 1e-6, "it cannot slow down that fast"
        left -= rate
        if left < 1e-9:
            break
    assert left == pytest.approx(0.0, abs=1e-6)
