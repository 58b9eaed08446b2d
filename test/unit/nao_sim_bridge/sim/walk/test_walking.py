"""A robot that really walks: where it gets to, and what its joints do meanwhile."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.curves import Ramp
from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.steps_course import Placement

MODEL = load_model()
LEGS = [f"{side}{joint}" for side in "LR" for joint in ("HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")]


# --- where it gets to ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "goal", [(0.3, 0.0, 0.0), (-0.12, 0.0, 0.0), (0.0, -0.1, 0.0), (0.0, 0.0, 0.8), (0.12, 0.08, -0.4)]
)
def test_it_gets_where_it_was_told_to_go(walker, goal):
    start, believed = walker.place(), walker.locomotion.position(use_sensors=True)
    task = walker.move_to(goal)
    assert walker.until(task) is True
    assert not walker.locomotion.active
    walker.run(0.2)
    assert walker.stands
    x, y, yaw = walker.place().seen_from(start)
    assert math.hypot(x - goal[0], y - goal[1]) < 0.03
    assert yaw == pytest.approx(goal[2], abs=0.06)
    # By its odometry, which it walks by, it comes closer.
    x, y, yaw = walker.locomotion.position(use_sensors=True).seen_from(believed)
    assert math.hypot(x - goal[0], y - goal[1]) < 0.015
    assert yaw == pytest.approx(goal[2], abs=0.05)
    assert walker.failures == []


def test_it_goes_through_points(walker):
    start = walker.place()
    task = walker.move_to((0.12, 0.0, 0.0), (0.2, 0.08, 0.0))
    nearest = math.inf
    while not task.finished:
        walker.simulation.tick()
        x, y, _ = walker.place().seen_from(start)
        nearest = min(nearest, math.hypot(x - 0.12, y))
    assert task.value is True
    assert nearest < 0.05
    x, y, _ = walker.place().seen_from(start)
    assert math.hypot(x - 0.2, y - 0.08) < 0.03


def test_it_takes_the_time_that_it_was_given(walker):
    begun = walker.now.time
    walker.until(walker.move_to((0.1, 0.0, 0.0), time=5.0))
    assert walker.now.time - begun > 5.0


def test_it_walks_at_the_velocity_that_was_asked_for(walker):
    walker.move(0.06, 0.0, 0.0)
    walker.run(3.0)
    begun = walker.place()
    walker.run(2.52)
    x, y, yaw = walker.place().seen_from(begun)
    assert x == pytest.approx(0.06 * 2.52, rel=0.12)
    assert abs(y) < 0.03 and abs(yaw) < 0.1
    assert walker.locomotion.velocity()[0] == pytest.approx(0.06, rel=0.1)


def test_another_velocity_takes_over_on_the_way(walker):
    walker.move(0.09, 0.0, 0.0)
    walker.run(2.5)
    walker.move(-0.06, 0.0, 0.0)
    walker.run(2.0)
    begun = walker.place()
    walker.run(1.5)
    assert walker.place().seen_from(begun).x < -0.05
    assert walker.locomotion.active


def test_of_two_goals_the_later_one_counts(walker):
    start = walker.place()
    first = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.5)
    second = walker.move_to((0.0, 0.05, 0.0))
    assert first.finished and first.value is False
    at = walker.place().seen_from(start)
    assert walker.until(second) is True
    x, y, _ = walker.place().seen_from(start)
    assert abs(x - at.x) < 0.06 and abs(y - at.y - 0.05) < 0.06


def test_two_walks_after_each_other(walker):
    for goal in [(0.08, 0.0, 0.0), (0.0, 0.0, -0.3)]:
        start = walker.place()
        assert walker.until(walker.move_to(goal)) is True
        x, y, yaw = walker.place().seen_from(start)
        assert (x, y) == pytest.approx(goal[:2], abs=0.025)
        assert yaw == pytest.approx(goal[2], abs=0.05)


def test_odometry_knows_where_it_went(walker):
    world = walker.place()
    believed = walker.locomotion.position(use_sensors=True)
    walker.locomotion.move_toward(0.6, 0.3, 0.4, walker.GAIT)
    walker.run(5.0)
    truth = walker.place().seen_from(world)
    odometry = walker.locomotion.position(use_sensors=True).seen_from(believed)
    assert math.hypot(*truth[:2]) > 0.1
    assert odometry[:2] == pytest.approx(truth[:2], abs=0.02)
    assert odometry.yaw == pytest.approx(truth.yaw, abs=0.03)


# --- footprints ---------------------------------------------------------------------------------------------------


def test_planned_steps_leave_exactly_these_footprints(walker):
    plan = [
        Placement(LEFT, FootPose(0.04, 0.1, 0.0), 0.5),
        Placement(RIGHT, FootPose(0.02, -0.12, -0.2), 0.5),
        Placement(LEFT, FootPose(0.0, 0.1, 0.0), 0.6),
    ]
    feet = walker.feet()
    task = walker.locomotion.set_steps(plan, walker.GAIT, clear=False)
    in_air = []
    while not task.finished:
        for step in walker.locomotion.steps().fixed:
            if not in_air or in_air[-1] != step.leg:
                in_air.append(step.leg)
        walker.simulation.tick()
    assert task.value is True
    assert in_air == ["LLeg", "RLeg", "LLeg"]
    for placement in plan:
        feet[placement.side] = feet[-placement.side].moved(*placement.beside)
    made = walker.feet()
    assert made[LEFT].seen_from(made[RIGHT]) == pytest.approx(feet[LEFT].seen_from(feet[RIGHT]), abs=0.01)
    for side in (LEFT, RIGHT):
        x, y, yaw = made[side].seen_from(feet[side])
        assert math.hypot(x, y) < 0.02 and abs(yaw) < 0.06


def test_steps_are_told_before_they_are_made(walker):
    plan = [Placement(side, FootPose(0.03, side * 0.1, 0.0), 0.5) for side in (LEFT, RIGHT, LEFT, RIGHT)]
    walker.locomotion.set_steps(plan, walker.GAIT, clear=False)
    while not walker.locomotion.steps().fixed:
        walker.simulation.tick()
    told = walker.locomotion.steps()
    assert [step.leg for step in (*told.fixed, *told.clearable)] == ["LLeg", "RLeg", "LLeg", "RLeg"]
    assert [step.placement for step in told.clearable] == [pytest.approx(p.beside) for p in plan[1:]]
    times = [step.time for step in (*told.fixed, *told.clearable)]
    assert [b - a for a, b in zip(times, times[1:])] == pytest.approx([0.5] * 3)
    for side, foot in ((LEFT, told.left), (RIGHT, told.right)):
        assert foot.seen_from(walker.feet()[side]) == pytest.approx((0.0, 0.0, 0.0), abs=0.01)


# --- joints -------------------------------------------------------------------------------------------------------


def test_joints_stay_in_their_limits_and_speeds(walker):
    joints = walker.model.joints
    walker.locomotion.move_toward(0.7, 0.0, 0.7, walker.GAIT)
    before = walker.robot.joints.commands
    for now in walker.watch(4.0):
        for joint, command, last in zip(joints, now.commands, before):
            assert joint.lower - 1e-6 <= command <= joint.upper + 1e-6, joint.name
            assert abs(command - last) <= joint.max_velocity * walker.simulation.settings.tick_s + 1e-6, joint.name
        before = now.commands
    assert walker.locomotion.active


def test_the_head_is_free_while_it_walks(walker):
    walker.move(0.06)
    walker.run(2.0)
    walker.aim(HeadYaw=0.8, HeadPitch=-0.2)
    walker.run(1.5)
    assert walker.joint("HeadYaw") == pytest.approx(0.8, abs=0.02)
    assert walker.joint("HeadPitch") == pytest.approx(-0.2, abs=0.02)
    assert walker.locomotion.active


def test_arms_swing_against_the_legs_and_give_way_to_who_wants_them(walker):
    joint = walker.model.joint_index["LShoulderPitch"]
    walker.move(0.08)
    walker.run(2.5)
    stride = [stride_of(walker) * swing_of(now) for now in ticks(walker, 1.0)]
    assert sum(stride) > 0.0, "the left arm is back when the left leg is ahead"
    greeting = walker.robot.motion.follow("wave", [joint], lambda commands: {joint: Ramp(commands[joint], 0.5, 1.0)})
    # Larger shoulder pitches point further back: the arm goes ahead as it is told, and not against it.
    told = []
    while not greeting.finished:
        told.append(walker.simulation.tick().commands[joint])
    assert len(told) > 60
    assert told == sorted(told, reverse=True)
    assert told[-1] == pytest.approx(0.5)
    assert max(swing_of(now) for now in ticks(walker, 1.5)) > 0.1, "it does not swing again"


def ticks(walker, seconds):
    """Snapshots, one after the other: what the walk is at can be looked at between them."""
    for _ in range(round(seconds / walker.simulation.settings.tick_s)):
        yield walker.simulation.tick()


def stride_of(walker):
    """How far the left foot is really ahead of the right one, m."""
    feet = walker.feet()
    return feet[LEFT].seen_from(feet[RIGHT]).x


def swing_of(now):
    """How far the left arm is further back than the right one, rad."""
    left, right = (now.positions[MODEL.joint_index[f"{side}ShoulderPitch"]] for side in "LR")
    return left - right


def test_a_walk_waits_for_what_moves_the_legs(walker):
    joint = walker.model.joint_index["LKneePitch"]
    bend = walker.robot.motion.follow("bend", [joint], lambda commands: {joint: Ramp(commands[joint], 0.9, 0.2)})
    task = walker.move_to((0.06, 0.0, 0.0))
    walker.run(0.5)
    assert not bend.finished
    assert walker.locomotion.active
    assert walker.locomotion.velocity() == (0.0, 0.0, 0.0)
    assert walker.until(bend) is None
    assert walker.until(task) is True
    assert walker.stands


def test_what_moves_the_legs_waits_for_a_walk(walker):
    task = walker.move_to((0.05, 0.0, 0.0))
    walker.run(0.5)
    joint = walker.model.joint_index["LKneePitch"]
    target = walker.joint("LKneePitch")
    bend = walker.robot.motion.follow("bend", [joint], lambda commands: {joint: Ramp(commands[joint], target, 0.3)})
    assert walker.until(task) is True
    assert not bend.finished
    walker.until(bend)


@pytest.mark.parametrize("posture", ["Stand", "StandZero", "Crouch"])
def test_it_begins_to_walk_from_wherever_it_stands(walker_in, posture):
    walker = walker_in(posture)
    start = walker.place()
    assert walker.until(walker.move_to((0.06, 0.0, 0.0))) is True
    assert walker.stands
    assert walker.place().seen_from(start).x == pytest.approx(0.06, abs=0.03)


def test_before_it_walks_it_can_take_its_stance(walker_in):
    walker = walker_in("Crouch")
    start = walker.place()
    walker.until(walker.locomotion.init())
    assert walker.stands
    assert walker.place().seen_from(start) == pytest.approx((0.0, 0.0, 0.0), abs=0.02)
    angles = [walker.joint(name) for name in LEGS]
    walker.until(walker.locomotion.init())
    assert [walker.joint(name) for name in LEGS] == pytest.approx(angles, abs=0.03), "it has its stance already"


def test_told_to_walk_while_it_takes_its_stance_it_goes_straight_from_there(walker):
    """It stands turned in the world of its odometry: nothing of that may show in its first step."""
    walker.until(walker.move_to((0.0, 0.0, 0.6)))
    begun = walker.place()
    walker.locomotion.init()
    walker.run(0.2)
    task = walker.move_to((0.1, 0.0, 0.0))
    while not walker.locomotion.steps().fixed:
        walker.simulation.tick()
    for step in (*walker.locomotion.steps().fixed, *walker.locomotion.steps().clearable):
        assert abs(step.placement.yaw) < 0.05
    assert walker.until(task) is True
    assert walker.place().seen_from(begun)[:2] == pytest.approx((0.1, 0.0), abs=0.025)
