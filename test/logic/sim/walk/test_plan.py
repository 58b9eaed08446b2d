"""The plan of a walk, followed tick by tick without physics."""

from __future__ import annotations

import math
from typing import NamedTuple

import pytest

from nao_sim_bridge.sim.walk.courses import STANDSTILL
from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.gait import FeetGait, feet_gait
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.plan import LONGEST_SWING, Phase, WalkPlan
from nao_sim_bridge.sim.walk.settings import load_walk_settings
from nao_sim_bridge.sim.walk.steps_course import Placement, StepsCourse
from nao_sim_bridge.sim.walk.target_course import TargetCourse
from nao_sim_bridge.sim.walk.velocity_course import VelocityCourse

SETTINGS = load_walk_settings()
DT = 1.0 / 120.0
# Fine enough that the pressure goes straight during a tick.
FINE = DT / 5.0
# Of the divergent component at one tick, m: what comes of following straight lines tick by tick, and what another
# course, or a stop within the next step, may ask for at once.
SMOOTH, CHANGED = 0.0002, 0.008
SIDES = (LEFT, RIGHT)


class Seen(NamedTuple):
    """A plan at a tick."""

    phase: Phase
    support: int
    swing_share: float
    both: bool
    divergent: tuple
    pressure: tuple
    com: tuple
    feet: dict
    in_air: dict


def plan_of(com=(0.01, 0.002), feet=None):
    return WalkPlan(SETTINGS, 9.81, feet or {s: FootPose(0.0, s * 0.05, 0.0) for s in SIDES}, com)


def velocity(x=0.04, y=0.0, yaw=0.0, rate=STANDSTILL, gait=None):
    return VelocityCourse(SETTINGS, gait or FeetGait(), (x, y, yaw), rate)


def steps(count, x=0.0, period=0.42):
    sides = [LEFT if i % 2 == 0 else RIGHT for i in range(count)]
    return StepsCourse(SETTINGS, FeetGait(), [Placement(s, FootPose(x, s * 0.1, 0.0), period) for s in sides])


def target(x, y, yaw):
    course = TargetCourse(SETTINGS, FeetGait(), [FootPose(x, y, yaw)])
    course.begin_towards(FootPose(0.0, 0.0, 0.0))
    return course


def tick(plan, landed=True, dt=DT):
    plan.advance(dt, landed)
    step = plan.step
    double = max(SETTINGS.double_support_share * step.period, step.period - LONGEST_SWING) if step else 0.0
    both = plan.phase is not Phase.STEP or plan.time < double
    in_air = {side: plan.foot(side) for side in SIDES}
    places = (plan.divergent, plan.pressure, plan.com)
    return Seen(plan.phase, plan.support, plan.swing_share, both, *places, dict(plan.feet), in_air)


def until(plan, phase, dt=DT):
    seen = []
    while plan.phase is not phase:
        seen.append(tick(plan, dt=dt))
        assert len(seen) < 20000
    return seen


def ticks(plan, seconds, dt=DT):
    return [tick(plan, dt=dt) for _ in range(round(seconds / dt))]


def standing(**options):
    """A plan that has its stance."""
    plan = plan_of(**options)
    until(plan, Phase.STAND)
    return plan


def whole_walk(course, end_after=None, dt=DT):
    """All ticks of a walk from the last one in its stance on."""
    plan = plan_of()
    seen = until(plan, Phase.STAND)[-1:]
    plan.begin(course)
    if end_after is not None:
        seen += ticks(plan, end_after, dt)
        course.end()
    return plan, seen + until(plan, Phase.STAND, dt)


def jumps(plan, seen, dt=FINE):
    """How far the divergent component is at each tick from where the pressure takes it since the tick before, m."""
    grown = math.exp(plan.omega * dt)

    def moved(divergent, pressure):
        return [grown * d + (1.0 - grown) * p for d, p in zip(divergent, pressure)]

    for before, now in zip(seen, seen[1:]):
        half_way = tuple((a + b) / 2.0 for a, b in zip(before.pressure, now.pressure))
        # Where the pressure itself jumps, at the start, it was at one of both places all the time.
        meanwhile = [half_way] if math.dist(before.pressure, now.pressure) < 0.01 else [before.pressure, now.pressure]
        yield min(math.dist(moved(before.divergent, at), now.divergent) for at in meanwhile)


COURSES = [
    (lambda: velocity(0.04), 3.0),
    (lambda: velocity(0.02, -0.01, -0.2), 3.1),
    (lambda: target(0.2, 0.1, 0.5), None),
    (lambda: steps(4, 0.02, 0.9), None),
]


def test_a_walk_goes_through_its_phases_in_order():
    plan = plan_of(com=(-0.02, 0.01))
    feet = dict(plan.feet)
    begun = until(plan, Phase.STAND)
    assert {now.phase for now in begun[:-1]} == {Phase.STANCE}
    assert len(begun) == pytest.approx(SETTINGS.stance_time / DT, abs=1)
    assert plan.com == pytest.approx(plan.rest()) and plan.feet == feet
    assert max(math.dist(a.com, b.com) for a, b in zip(begun, begun[1:])) < 0.001
    plan.begin(steps(3))
    seen = until(plan, Phase.STAND)
    order = [now.phase for now in seen]
    first = [phase for i, phase in enumerate(order) if i == 0 or order[i - 1] is not phase]
    assert first == [Phase.START, Phase.STEP, Phase.SETTLE, Phase.STAND]
    assert [now.support for now in seen if now.phase is Phase.STEP][10 :: round(0.42 / DT)] == [RIGHT, LEFT, RIGHT]
    lasted = [order.count(phase) * DT for phase in first[:3]]
    start, settle = SETTINGS.push_time + SETTINGS.shift_time, SETTINGS.settle_time + SETTINGS.stand_time
    assert lasted == pytest.approx([start, 3 * 0.42, settle], abs=2 * DT)


@pytest.mark.parametrize("course, end_after", COURSES)
def test_nothing_jumps_one_foot_is_in_the_air_and_it_ends_at_rest_over_both_feet(course, end_after):
    plan, seen = whole_walk(course(), end_after, FINE)
    found = sorted(jumps(plan, seen))
    assert found[-2] < SMOOTH, "besides the tick at which it was told to end"
    assert found[-1] < (SMOOTH if end_after is None else CHANGED)
    for before, now in zip(seen, seen[1:]):
        assert min(now.in_air[side].height for side in SIDES) == 0.0
        assert now.phase is not Phase.STEP or now.in_air[now.support].height == 0.0
        for side in SIDES:
            (ax, ay, _), (bx, by, _) = before.in_air[side].pose, now.in_air[side].pose
            assert math.hypot(bx - ax, by - ay) < 0.003
            assert abs(now.in_air[side].height - before.in_air[side].height) < 0.0006
    assert plan.divergent == pytest.approx(plan.rest(), abs=1e-6)
    # From at most the width of the stance, the centre of mass comes nearer with the pendulum's own pace.
    nearly = 0.1 * math.exp(-plan.omega * (SETTINGS.settle_time + SETTINGS.stand_time))
    assert plan.com == pytest.approx(plan.rest(), abs=nearly)
    assert plan.step is None and not plan.walking
    stood = ticks(plan, 1.0)
    assert stood[-1].feet == seen[-1].feet and stood[-1].com == pytest.approx(plan.rest(), abs=1e-5)


@pytest.mark.parametrize("height", [0.005, 0.035])
def test_feet_go_as_high_as_the_gait_says_and_a_bit_more(height):
    _, seen = whole_walk(velocity(gait=feet_gait({"StepHeight": height})), end_after=1.5)
    for side in SIDES:
        highest = max(now.in_air[side].height for now in seen)
        assert highest == pytest.approx(height + SETTINGS.extra_lift, abs=5e-4)


def late():
    """A plan at the last tick before its first step, of the left foot, ends."""
    plan = standing()
    plan.begin(steps(3))
    while not (plan.phase is Phase.STEP and plan.time > plan.step.period - 1.5 * DT):
        tick(plan)
    return plan


def test_a_foot_that_does_not_feel_the_ground_goes_down_and_is_waited_for():
    plan, heights = late(), []
    while plan.support == RIGHT:
        heights.append(tick(plan, landed=False).in_air[LEFT].height)
    assert len(heights) * DT == pytest.approx(SETTINGS.latest, abs=2 * DT)
    assert min(heights) == pytest.approx(-SETTINGS.sink, abs=2e-3)
    assert plan.waited == 0.0
    plan = late()
    for _ in range(3):
        tick(plan, landed=False)
    assert plan.support == RIGHT
    ticks(plan, 2 * DT)
    assert plan.support == LEFT, "it has landed"
