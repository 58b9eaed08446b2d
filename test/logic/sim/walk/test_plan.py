"""The plan of a walk of planned steps, followed tick by tick without physics."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import feet_gait
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.plan import Phase, WalkPlan
from nao_sim_bridge.walk.settings import load_walk_settings
from nao_sim_bridge.walk.steps_course import Placement, StepsCourse

SETTINGS = load_walk_settings()
DT, PERIOD = 1.0 / 120.0, 0.42


def steps(count, **gait):
    sides = [LEFT if i % 2 == 0 else RIGHT for i in range(count)]
    return StepsCourse(SETTINGS, feet_gait(gait), [Placement(s, FootPose(0.0, s * 0.1, 0.0), PERIOD) for s in sides])


@pytest.fixture
def plan():
    return WalkPlan(SETTINGS, 9.81, {s: FootPose(0.0, s * 0.05, 0.0) for s in (LEFT, RIGHT)}, (-0.02, 0.01))


def until(plan, condition, landed=True):
    """(phase, foot that carries, centre of mass, height of the left foot) at each tick."""
    seen = []
    while not condition(plan):
        plan.advance(DT, landed)
        seen.append((plan.phase, plan.support, plan.com, plan.foot(LEFT).height))
        assert len(seen) < 2000
    return seen


def stands(plan):
    return plan.phase is Phase.STAND


def test_a_walk_goes_through_its_phases_in_order(plan):
    begun = until(plan, stands)
    assert {phase for phase, *_ in begun[:-1]} == {Phase.STANCE}
    assert len(begun) == pytest.approx(SETTINGS.stance_time / DT, abs=1) and plan.com == pytest.approx(plan.rest())
    assert max(math.dist(a[2], b[2]) for a, b in zip(begun, begun[1:])) < 0.001
    plan.begin(steps(3))
    seen = until(plan, stands)
    order = [phase for phase, *_ in seen]
    assert list(dict.fromkeys(order)) == [Phase.START, Phase.STEP, Phase.SETTLE, Phase.STAND]
    assert [row[1] for row in seen if row[0] is Phase.STEP][10 :: round(PERIOD / DT)] == [RIGHT, LEFT, RIGHT]
    start, settle = SETTINGS.push_time + SETTINGS.shift_time, SETTINGS.settle_time + SETTINGS.stand_time
    lasted = [order.count(phase) * DT for phase in (Phase.START, Phase.STEP, Phase.SETTLE)]
    assert lasted == pytest.approx([start, 3 * PERIOD, settle], abs=2 * DT)
    assert plan.divergent == pytest.approx(plan.rest(), abs=1e-6) and not plan.walking


@pytest.mark.parametrize("height", [0.005, 0.035])
def test_feet_go_as_high_as_the_gait_says_and_a_bit_more(plan, height):
    until(plan, stands)
    plan.begin(steps(2, StepHeight=height))
    assert max(row[3] for row in until(plan, stands)) == pytest.approx(height + SETTINGS.extra_lift, abs=5e-4)


def test_a_foot_that_does_not_feel_the_ground_goes_down_and_is_waited_for(plan):
    until(plan, stands)
    plan.begin(steps(3))
    until(plan, lambda plan: plan.phase is Phase.STEP and plan.time > PERIOD - 1.5 * DT)
    heights = [row[3] for row in until(plan, lambda plan: plan.support == LEFT, landed=False)]
    assert len(heights) * DT == pytest.approx(SETTINGS.latest, abs=2 * DT)
    assert min(heights) == pytest.approx(-SETTINGS.sink, abs=2e-3) and plan.waited == 0.0
