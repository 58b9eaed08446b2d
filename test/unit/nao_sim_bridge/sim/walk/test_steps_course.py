"""Walking by steps that somebody else has planned."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.walk.clipping import clip_step, step_limits
from nao_sim_bridge.sim.walk.courses import STANDSTILL
from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.gait import FeetGait, feet_gait
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.settings import load_walk_settings
from nao_sim_bridge.sim.walk.steps_course import Placement, StepsCourse

SIDE_BY_SIDE = {1: FootPose(0.0, 0.05, 0.0), -1: FootPose(0.0, -0.05, 0.0)}

SETTINGS = load_walk_settings()


def step(side, x=0.04, y=None, yaw=0.0, period=0.5):
    return Placement(side, FootPose(x, side * 0.1 if y is None else y, yaw), period)


def course(*steps, gait=None):
    return StepsCourse(SETTINGS, gait or FeetGait(), steps)


PLAN = [step(LEFT), step(RIGHT, 0.02, -0.12, -0.2), step(LEFT, 0.0, 0.1, 0.0, 0.55), step(RIGHT, 0.0)]


def test_it_makes_exactly_the_steps_of_the_plan(walked):
    one = course(*PLAN)
    made = walked(one)
    assert [m.step.side for m in made] == [s.side for s in PLAN]
    for m, planned in zip(made, PLAN):
        assert m.placement == pytest.approx(planned.beside)
        assert m.step.period == pytest.approx(planned.period)
    assert one.reached


def test_the_foot_of_the_first_step_moves_first():
    assert course(step(RIGHT), step(LEFT)).first_side(SIDE_BY_SIDE) == RIGHT
    assert course().first_side(SIDE_BY_SIDE) == LEFT


def test_it_is_over_after_its_last_step_and_not_before(walked):
    one = course(*PLAN)
    made = walked(one, len(PLAN) - 1)
    assert not one.reached
    assert len(one.left) == 1
    walked(one, after=made[-1])
    assert one.reached
    assert one.left == ()


def test_what_the_legs_cannot_step_is_clipped(walked):
    far = step(LEFT, 0.3, 0.3, 1.0)
    (made,) = walked(course(far))
    assert made.placement == pytest.approx(clip_step(far.beside, LEFT, step_limits()))


def test_no_step_is_quicker_than_the_shortest_one(walked):
    (made,) = walked(course(step(LEFT, period=0.1)))
    assert made.step.period == pytest.approx(0.42)
    (made,) = walked(course(step(LEFT, period=0.1), gait=feet_gait({"MaxStepFrequency": 0.0})))
    assert made.step.period == pytest.approx(0.6)


def test_between_two_steps_of_one_foot_the_other_one_comes_beside_it(walked):
    made = walked(course(step(LEFT), step(LEFT), step(RIGHT, 0.0)))
    assert [m.step.side for m in made] == [LEFT, RIGHT, LEFT, RIGHT]
    assert made[1].placement == pytest.approx((0.0, -0.1, 0.0))
    assert made[2].placement == pytest.approx((0.04, 0.1, 0.0))
    assert made[2].robot.x == pytest.approx(0.06)


def test_steps_can_be_added_to_those_that_are_planned(walked):
    one = course(*PLAN[:2])
    made = walked(one, 1)
    one.add(PLAN[2:], clear=False)
    assert one.left == tuple(PLAN[1:])
    made += walked(one, after=made[-1])
    assert [m.placement for m in made] == [pytest.approx(p.beside) for p in PLAN]


def test_steps_can_take_the_place_of_those_that_are_planned(walked):
    one = course(step(LEFT), step(RIGHT), step(LEFT))
    made = walked(one, 1)
    back = step(RIGHT, -0.03)
    one.add([back], clear=True)
    rest = walked(one, after=made[-1])
    assert [m.placement for m in rest] == [pytest.approx(back.beside)]


def test_nothing_at_all_is_over_at_once(walked):
    assert walked(course()) == []
    one = course(*PLAN)
    made = walked(one, 2)
    one.add([], clear=True)
    assert walked(one, after=made[-1]) == []


def test_looking_ahead_changes_nothing(feet_at):
    one = course(*PLAN)
    ahead = one.upcoming(feet_at()[RIGHT], LEFT, 10)
    assert len(ahead) == len(PLAN)
    assert one.upcoming(feet_at()[RIGHT], LEFT, 10) == ahead
    assert one.left == tuple(PLAN)
    assert one.rate == STANDSTILL
