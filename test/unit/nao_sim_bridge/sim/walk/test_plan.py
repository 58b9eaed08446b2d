"""The plan of a walk, followed tick by tick without physics."""

from __future__ import annotations

import math
import random
from typing import NamedTuple

import pytest

from nao_sim_bridge.sim.body_mass import convex_hull
from nao_sim_bridge.sim.support_polygon import outside
from nao_sim_bridge.sim.walk.clipping import step_limits
from nao_sim_bridge.sim.walk.courses import STANDSTILL
from nao_sim_bridge.sim.walk.footsteps import FootPose, middle
from nao_sim_bridge.sim.walk.gait import FeetGait, feet_gait
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.plan import LONGEST_SWING, Phase, WalkPlan
from nao_sim_bridge.sim.walk.settings import load_walk_settings
from nao_sim_bridge.sim.walk.steps_course import Placement, StepsCourse
from nao_sim_bridge.sim.walk.target_course import TargetCourse
from nao_sim_bridge.sim.walk.velocity_course import VelocityCourse

SETTINGS = load_walk_settings()
GRAVITY = 9.81
DT = 1.0 / 120.0
LIMITS = step_limits()
# Fine enough that the pressure goes straight during a tick.
FINE = DT / 5.0
# Longest that any walk of these tests takes, ticks.
LONGEST = 20000
# Of the divergent component at one tick, m: what comes of following straight lines tick by tick, and what another
# course, or a stop within the next step, may ask for at once.
SMOOTH, CHANGED = 0.0002, 0.008


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
    return WalkPlan(SETTINGS, GRAVITY, feet or {s: FootPose(0.0, s * 0.05, 0.0) for s in (LEFT, RIGHT)}, com)


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
    in_air = {side: plan.foot(side) for side in (LEFT, RIGHT)}
    return Seen(
        plan.phase,
        plan.support,
        plan.swing_share,
        both,
        plan.divergent,
        plan.pressure,
        plan.com,
        dict(plan.feet),
        in_air,
    )


def stand(plan):
    """Until the stance is taken."""
    return until(plan, Phase.STAND)


def until(plan, phase, dt=DT):
    seen = []
    while plan.phase is not phase:
        seen.append(tick(plan, dt=dt))
        assert len(seen) < LONGEST
    return seen


def ticks(plan, seconds, dt=DT):
    return [tick(plan, dt=dt) for _ in range(round(seconds / dt))]


def whole_walk(course, end_after=None, dt=DT):
    """All ticks of a walk from the last one in its stance on."""
    plan = plan_of()
    seen = stand(plan)[-1:]
    plan.begin(course)
    if end_after is not None:
        seen += ticks(plan, end_after, dt)
        course.end()
    return plan, seen + until(plan, Phase.STAND, dt)


def random_walk(seed, dt=DT):
    """All ticks of a walk whose velocity changes at random moments."""
    r = random.Random(seed)
    plan = plan_of()
    seen = stand(plan)[-1:]
    course = velocity(*(r.uniform(-most, most) for most in (0.05, 0.03, 0.4)))
    plan.begin(course)
    seen += ticks(plan, r.uniform(1.0, 2.0), dt)
    for _ in range(3):
        course = velocity(*(r.uniform(-most, most) for most in (0.05, 0.03, 0.4)), rate=course.rate)
        plan.take_course(course)
        seen += ticks(plan, r.uniform(0.3, 2.0), dt)
    course.end()
    return plan, seen + until(plan, Phase.STAND, dt)


def jumps(plan, seen, dt=FINE):
    """How far the divergent component is at each tick from where the pressure takes it since the tick before, m."""
    grown = math.exp(plan.omega * dt)
    for before, now in zip(seen, seen[1:]):
        half_way = tuple((a + b) / 2.0 for a, b in zip(before.pressure, now.pressure))
        # Where the pressure itself jumps, at the start, it was at one of both places all the time.
        meanwhile = [half_way] if math.dist(before.pressure, now.pressure) < 0.01 else [before.pressure, now.pressure]
        yield min(math.dist(moved(before.divergent, at, grown), now.divergent) for at in meanwhile)


def moved(divergent, pressure, grown):
    return [grown * d + (1.0 - grown) * p for d, p in zip(divergent, pressure)]


def corners(feet, side):
    return [(p.x, p.y) for p in (feet[side].moved(x, y) for x, y in LIMITS.box(side))]


COURSES = [
    (lambda: velocity(0.04), 3.0),
    (lambda: velocity(-0.04), 3.0),
    (lambda: velocity(0.0, 0.026), 3.0),
    (lambda: velocity(0.02, -0.01, -0.2), 3.1),
    (lambda: velocity(0.0, 0.0, 0.349), 2.9),
    (lambda: target(0.3, 0.1, 0.5), None),
    (lambda: steps(1), None),
    (lambda: steps(6, 0.04), None),
    (lambda: steps(4, 0.02, 0.9), None),
]


# --- phases -------------------------------------------------------------------------------------------------------


def test_a_walk_goes_through_its_phases_in_order():
    plan = plan_of()
    begun = stand(plan)
    assert {now.phase for now in begun[:-1]} == {Phase.STANCE}
    assert len(begun) == pytest.approx(SETTINGS.stance_time / DT, abs=1)
    plan.begin(steps(3))
    seen = until(plan, Phase.STAND)
    order = [now.phase for now in seen]
    first = [phase for i, phase in enumerate(order) if i == 0 or order[i - 1] is not phase]
    assert first == [Phase.START, Phase.STEP, Phase.SETTLE, Phase.STAND]
    lasted = {phase: order.count(phase) * DT for phase in first}
    assert lasted[Phase.START] == pytest.approx(SETTINGS.push_time + SETTINGS.shift_time, abs=2 * DT)
    assert lasted[Phase.STEP] == pytest.approx(3 * 0.42, abs=2 * DT)
    assert lasted[Phase.SETTLE] == pytest.approx(SETTINGS.settle_time + SETTINGS.stand_time, abs=2 * DT)


def test_the_stance_takes_the_body_over_the_middle_of_the_feet_and_leaves_feet_alone():
    plan = plan_of(com=(-0.02, 0.01))
    feet = dict(plan.feet)
    seen = stand(plan)
    assert plan.com == pytest.approx(plan.rest())
    assert plan.feet == feet
    assert max(math.dist(a.com, b.com) for a, b in zip(seen, seen[1:])) < 0.001


def test_steps_take_turns():
    _, seen = whole_walk(velocity(), end_after=3.0)
    supports = [now.support for now in seen if now.phase is Phase.STEP]
    lasted = [i for i, side in enumerate(supports) if i == 0 or supports[i - 1] != side]
    assert supports[0] == RIGHT
    assert len(lasted) > 6
    assert [b - a for a, b in zip(lasted, lasted[1:])] == pytest.approx([0.42 / DT] * (len(lasted) - 1), abs=1)


def test_a_walk_can_be_begun_again_from_where_it_ended():
    plan, _ = whole_walk(steps(3, 0.04))
    assert (plan.feet[LEFT].x, plan.feet[RIGHT].x) == pytest.approx((0.12, 0.08))
    plan.begin(velocity(0.03))
    ticks(plan, 2.0)
    assert plan.robot.x > 0.12


@pytest.mark.parametrize("placement", [FootPose(0.04, -0.1, 0.0), FootPose(0.0, -0.12, -0.3)])
def test_feet_are_put_exactly_where_the_course_says(placement):
    plan, _ = whole_walk(StepsCourse(SETTINGS, FeetGait(), [Placement(RIGHT, placement, 0.5)]))
    assert plan.feet[RIGHT].seen_from(plan.feet[LEFT]) == pytest.approx(placement)
    assert plan.feet[LEFT] == (0.0, 0.05, 0.0)


def test_the_longer_a_step_the_longer_it_stands_on_both_feet():
    for period, in_air in [(0.42, 0.42 * (1.0 - SETTINGS.double_support_share)), (1.0, LONGEST_SWING)]:
        _, seen = whole_walk(steps(3, period=period))
        moving = [now for now in seen if 0.0 < now.swing_share < 1.0]
        assert len(moving) * DT == pytest.approx(3 * in_air, abs=6 * DT)


# --- the body -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("course, end_after", COURSES)
def test_the_divergent_component_never_jumps(course, end_after):
    plan, seen = whole_walk(course(), end_after, FINE)
    found = sorted(jumps(plan, seen))
    assert found[-2] < SMOOTH, "besides the tick at which it was told to end"
    assert found[-1] < (SMOOTH if end_after is None else CHANGED)


@pytest.mark.parametrize("seed", range(12))
def test_another_course_moves_the_divergent_component_by_little(seed):
    plan, seen = random_walk(seed, FINE)
    found = sorted(jumps(plan, seen))
    assert found[-1] < CHANGED
    assert found[-5] < SMOOTH, "besides the ticks at which one of four courses came"


@pytest.mark.parametrize("seed", range(12))
def test_the_pressure_stays_under_the_soles_that_carry(seed):
    for now in random_walk(seed)[1]:
        sides = (LEFT, RIGHT) if now.both else (now.support,)
        hull = convex_hull([corner for side in sides for corner in corners(now.feet, side)])
        assert outside(hull, now.pressure)[0] <= 0.0, now


@pytest.mark.parametrize("seed", range(12))
def test_the_body_stays_over_its_feet(seed):
    plan, seen = random_walk(seed)
    for now in seen:
        between = middle(now.feet[LEFT], now.feet[RIGHT])
        assert math.dist(now.com, between[:2]) < 0.06
    fastest = max(math.dist(a.com, b.com) / DT for a, b in zip(seen, seen[1:]))
    assert fastest < 0.5


@pytest.mark.parametrize("course, end_after", COURSES)
def test_it_ends_at_rest_over_both_feet(course, end_after):
    plan, seen = whole_walk(course(), end_after)
    assert plan.divergent == pytest.approx(plan.rest(), abs=1e-6)
    # From at most the width of the stance, the centre of mass comes nearer with the pendulum's own pace.
    nearly = 0.1 * math.exp(-plan.omega * (SETTINGS.settle_time + SETTINGS.stand_time))
    assert plan.com == pytest.approx(plan.rest(), abs=nearly)
    assert math.dist(seen[-1].com, seen[-2].com) / DT < 1.1 * plan.omega * nearly
    assert plan.step is None and not plan.walking
    assert [plan.foot(side).height for side in (LEFT, RIGHT)] == [0.0, 0.0]


def test_while_it_stands_nothing_changes():
    plan, seen = whole_walk(steps(2))
    stood = ticks(plan, 1.0)
    assert stood[-1].feet == seen[-1].feet
    assert stood[-1].com == pytest.approx(plan.rest(), abs=1e-5)


# --- the foot in the air ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("course, end_after", COURSES)
def test_feet_never_jump_and_only_one_is_in_the_air(course, end_after):
    _, seen = whole_walk(course(), end_after)
    for before, now in zip(seen, seen[1:]):
        heights = [now.in_air[side].height for side in (LEFT, RIGHT)]
        assert min(heights) == 0.0
        if now.phase is Phase.STEP:
            assert now.in_air[now.support].height == 0.0
        for side in (LEFT, RIGHT):
            (ax, ay, _), (bx, by, _) = before.in_air[side].pose, now.in_air[side].pose
            assert math.hypot(bx - ax, by - ay) < 0.014
            assert abs(now.in_air[side].height - before.in_air[side].height) < 0.003


@pytest.mark.parametrize("height", [0.005, 0.02, 0.035])
def test_feet_go_as_high_as_the_gait_says_and_a_bit_more(height):
    _, seen = whole_walk(velocity(gait=feet_gait({"StepHeight": height})), end_after=2.0)
    highest = max(now.in_air[side].height for now in seen if now.phase is Phase.STEP for side in (LEFT, RIGHT))
    assert highest == pytest.approx(height + SETTINGS.extra_lift, abs=3e-3)


def late(plan, course):
    """The plan at the last tick before its first step ends."""
    plan.begin(course)
    while not (plan.phase is Phase.STEP and plan.time > plan.step.period - 1.5 * DT):
        tick(plan)
    return plan


def test_a_foot_that_does_not_feel_the_ground_goes_down_and_is_waited_for():
    plan = plan_of()
    stand(plan)
    late(plan, steps(3))
    waited = 0
    heights = []
    while plan.support == RIGHT:
        heights.append(tick(plan, landed=False).in_air[LEFT].height)
        waited += 1
    assert waited * DT == pytest.approx(SETTINGS.latest, abs=2 * DT)
    assert min(heights) == pytest.approx(-SETTINGS.sink, abs=2e-3)
    assert plan.waited == 0.0


def test_a_foot_that_lands_is_not_waited_for_any_longer():
    plan = plan_of()
    stand(plan)
    late(plan, steps(3))
    for _ in range(3):
        tick(plan, landed=False)
    assert plan.support == RIGHT
    ticks(plan, 2 * DT)
    assert plan.support == LEFT


# --- what it tells ------------------------------------------------------------------------------------------------


def test_the_robot_is_where_its_feet_are_when_the_step_is_done():
    plan = plan_of()
    stand(plan)
    assert plan.robot == pytest.approx((0.0, 0.0, 0.0))
    plan.begin(steps(3, 0.04))
    until(plan, Phase.STEP)
    assert plan.robot == pytest.approx((0.02, 0.0, 0.0))


def test_further_steps_are_those_that_come():
    plan = plan_of()
    stand(plan)
    assert plan.further(3) == []
    plan.begin(steps(4, 0.03))
    until(plan, Phase.STEP)
    expected = plan.further(10)
    assert len(expected) == 3
    made = []
    while plan.phase is Phase.STEP:
        before = plan.support
        tick(plan)
        if plan.phase is Phase.STEP and plan.support != before:
            made.append(plan.step)
    assert made == expected


def test_a_plan_lies_wherever_the_feet_stand():
    """The same walk elsewhere and turned is the same walk."""
    place = FootPose(1.0, -2.0, 2.3)
    at = place.moved(0.02, 0.0)
    here = plan_of(com=(0.02, 0.0))
    there = plan_of(com=at[:2], feet={s: place.moved(0.0, s * 0.05) for s in (LEFT, RIGHT)})
    for plan in (here, there):
        stand(plan)
        plan.begin(velocity(0.03, 0.01, 0.1))
    for _ in range(250):
        one, other = tick(here), tick(there)
        for a, b in [(one.com, other.com), (one.divergent, other.divergent), (one.pressure, other.pressure)]:
            assert place.moved(*a)[:2] == pytest.approx(b, abs=1e-9)
