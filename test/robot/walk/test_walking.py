"""A robot that really walks: where it gets to, and what its joints do meanwhile."""

import math

import pytest

from nao_sim_bridge.control.joints.curves import Ramp
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.steps_course import Placement

MODEL = load_model()
KNEE = MODEL.joint_index["LKneePitch"]
LEGS = [f"{side}{joint}" for side in "LR" for joint in ("HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")]


@pytest.mark.parametrize("goal", [(0.2, 0.0, 0.0), (-0.12, 0.0, 0.0), (0.0, 0.3, 0.0), (0.1, 0.06, -0.6)])
def test_it_gets_where_it_was_told_to_go(walker, goal):
    start, believed = walker.place(), walker.locomotion.position(use_sensors=True)
    assert walker.until(walker.move_to(goal)) is True
    assert not walker.locomotion.active and walker.failures == []
    walker.run(0.2)
    assert walker.stands
    x, y, yaw = walker.place().seen_from(start)
    bx, by, byaw = walker.locomotion.position(use_sensors=True).seen_from(believed)
    assert math.hypot(x - goal[0], y - goal[1]) < 0.008 and yaw == pytest.approx(goal[2], abs=0.008)
    assert math.hypot(bx - goal[0], by - goal[1]) < 0.004 and byaw == pytest.approx(goal[2], abs=0.008)


def test_it_goes_through_points_in_the_time_that_it_was_given(walker):
    start, begun = walker.place(), walker.now.time
    task = walker.move_to((0.1, 0.0, 0.0), (0.14, 0.06, 0.0), time=6.0)
    nearest = math.inf
    while not task.finished:
        walker.simulation.tick()
        x, y, _ = walker.place().seen_from(start)
        nearest = min(nearest, math.hypot(x - 0.1, y))
    assert task.value is True
    assert nearest < 0.035
    assert math.hypot(x - 0.14, y - 0.06) < 0.011
    assert 6.0 < walker.now.time - begun < 9.0


def test_it_walks_at_the_velocity_that_was_asked_for_and_another_one_takes_over(walker):
    walker.move(0.06, 0.0, 0.0)
    walker.run(2.5)
    begun = walker.place()
    walker.run(2.52)
    x, y, yaw = walker.place().seen_from(begun)
    assert (x, y, yaw) == pytest.approx((0.06 * 2.52, 0.0, 0.0), abs=0.007)
    assert walker.locomotion.velocity() == pytest.approx((0.06, 0.0, 0.0), abs=0.006)
    assert len(walker.locomotion.steps().clearable) == 4
    walker.move(-0.06, 0.0, 0.0)
    walker.run(2.0)
    begun = walker.place()
    walker.run(1.0)
    assert walker.place().seen_from(begun).x == pytest.approx(-0.06, abs=0.01)
    assert walker.locomotion.active


def test_odometry_knows_where_it_went(walker):
    world, believed = walker.place(), walker.locomotion.position(use_sensors=True)
    walker.locomotion.move_toward(0.6, 0.3, 0.4, walker.GAIT)
    joints, before = walker.model.joints, walker.robot.joints.commands
    for now in walker.watch(4.0):
        for joint, command, last in zip(joints, now.commands, before):
            assert joint.lower - 1e-6 <= command <= joint.upper + 1e-6, joint.name
            assert abs(command - last) <= joint.max_velocity * walker.simulation.settings.tick_s + 1e-6, joint.name
        before = now.commands
    truth = walker.place().seen_from(world)
    odometry = walker.locomotion.position(use_sensors=True).seen_from(believed)
    assert math.hypot(*truth[:2]) > 0.1
    assert odometry == pytest.approx(truth, abs=0.002)


@pytest.mark.parametrize("posture", ["Crouch", "StandZero"])
def test_before_it_walks_it_takes_its_stance_from_wherever_it_stands(walker_in, posture):
    walker = walker_in(posture)
    start = walker.place()
    walker.until(walker.locomotion.init())
    assert walker.stands
    assert walker.place().seen_from(start) == pytest.approx((0.0, 0.0, 0.0), abs=0.008)
    angles = [walker.joint(name) for name in LEGS]
    walker.until(walker.locomotion.init())
    assert [walker.joint(name) for name in LEGS] == pytest.approx(angles, abs=0.03), "it has its stance already"


def test_planned_steps_are_told_before_they_are_made_and_leave_exactly_these_footprints(walker):
    plan = [
        Placement(LEFT, FootPose(0.04, 0.1, 0.0), 0.5),
        Placement(RIGHT, FootPose(0.02, -0.12, -0.2), 0.5),
        Placement(LEFT, FootPose(0.0, 0.1, 0.0), 0.6),
    ]
    feet = walker.feet()
    task = walker.locomotion.set_steps(plan, walker.GAIT, clear=False)
    in_air, told = [], None
    while not task.finished:
        now = walker.locomotion.steps()
        told = told or (now if now.fixed else None)
        in_air += [step.leg for step in now.fixed if in_air[-1:] != [step.leg]]
        walker.simulation.tick()
    assert task.value is True
    assert in_air == ["LLeg", "RLeg", "LLeg"] == [step.leg for step in (*told.fixed, *told.clearable)]
    assert [step.placement for step in told.clearable] == [pytest.approx(p.beside) for p in plan[1:]]
    assert [step.time - told.fixed[0].time for step in told.clearable] == pytest.approx([0.5, 1.1])
    for side, foot in ((LEFT, told.left), (RIGHT, told.right)):
        assert foot.seen_from(feet[side]) == pytest.approx((0.0, 0.0, 0.0), abs=0.01)
    for placement in plan:
        feet[placement.side] = feet[-placement.side].moved(*placement.beside)
    made = walker.feet()
    assert made[LEFT].seen_from(made[RIGHT]) == pytest.approx(feet[LEFT].seen_from(feet[RIGHT]), abs=0.005)
    for side in (LEFT, RIGHT):
        x, y, yaw = made[side].seen_from(feet[side])
        assert math.hypot(x, y) < 0.003 and abs(yaw) < 0.018


def test_a_walk_waits_for_what_moves_the_legs_and_that_for_a_walk(walker):
    bend = walker.robot.motion.follow("bend", [KNEE], lambda commands: {KNEE: Ramp(commands[KNEE], 0.9, 0.2)})
    task = walker.move_to((0.05, 0.0, 0.0))
    walker.run(0.5)
    assert not bend.finished and walker.locomotion.active
    assert walker.locomotion.velocity() == (0.0, 0.0, 0.0)
    assert walker.until(bend) is None
    walker.run(0.5)
    back = walker.robot.motion.follow("back", [KNEE], lambda commands: {KNEE: Ramp(commands[KNEE], 0.85, 0.3)})
    assert walker.until(task) is True
    assert walker.stands and not back.finished
    walker.until(back)
    assert walker.robot.joints.commands[KNEE] == pytest.approx(0.85)
