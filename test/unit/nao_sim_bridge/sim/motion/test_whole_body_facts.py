"""Whole body control of a robot in the physics: it really stands on one foot."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import FEET
from nao_sim_bridge.sim.motion.footholds import FootState
from nao_sim_bridge.sim.motion.whole_body_aims import TargetAim
from nao_sim_bridge.sim.motion.whole_body_tasks import go_to_balance
from nao_sim_bridge.sim.rotations import roll_pitch_yaw

SPEED = (0.1, 1.0)
OTHER = dict(zip(FEET, reversed(FEET)))


def upright(snapshot):
    return max(abs(angle) for angle in roll_pitch_yaw(snapshot.torso.orientation)[:2]) < 0.2


def loads(snapshot):
    """What the feet carry, N."""
    return {"LLeg": snapshot.left_foot.total, "RLeg": snapshot.right_foot.total}


@pytest.fixture
def over(bench):
    """Makes standing robots whose centre of mass is over one foot, the other one free."""

    def make(foot):
        one = bench("StandInit")
        one.run(0.2)
        robot = one.robot
        robot.whole_body.enable(True)
        task = go_to_balance(robot.whole_body, robot.motion, robot.joints, "go", [foot], 1.5)
        one.run(2.0)
        assert task.value is True
        robot.whole_body.set_foot_states([OTHER[foot]], FootState.FREE)
        return one

    return make


@pytest.mark.parametrize("foot", FEET)
def test_it_stands_on_one_foot(over, foot):
    one = over(foot)
    assert loads(one.now)[foot] > 35.0
    control = one.robot.whole_body
    goal = control.goal_here(OTHER[foot])
    raised = goal.pose.copy()
    raised[2, 3] += 0.05
    control.lead(OTHER[foot], TargetAim(goal, raised, SPEED))
    one.run(2.0)
    held = one.watch(5.0)
    assert all(loads(snapshot)[OTHER[foot]] == 0.0 for snapshot in held)
    assert upright(held[-1])
    drift = np.subtract(held[-1].torso.position, held[0].torso.position)
    assert np.abs(drift).max() < 2e-3


def test_a_leg_that_is_raised_by_its_joints_does_not_tip_the_robot_over(over):
    one = over("LLeg")
    one.aim(speed=0.4, RHipPitch=-0.9, RKneePitch=1.4, RAnklePitch=-0.5)
    one.run(1.5)
    held = one.watch(1.5)
    assert all(snapshot.right_foot.total == 0.0 for snapshot in held)
    assert upright(held[-1])


def test_without_whole_body_control_the_same_leg_tips_it_over(bench):
    one = bench("StandInit")
    one.run(0.2)
    one.aim(speed=0.4, RHipPitch=-0.9, RKneePitch=1.4, RAnklePitch=-0.5)
    assert not upright(one.run(5.0))


def test_arms_that_move_do_not_tip_a_robot_on_one_foot_over(over):
    one = over("RLeg")
    one.aim(speed=0.4, LHipPitch=-0.9, LKneePitch=1.4, LAnklePitch=-0.5)
    one.run(1.5)
    one.aim(speed=1.0, LShoulderRoll=1.2, LShoulderPitch=0.5, RShoulderPitch=-0.5)
    one.run(1.5)
    assert upright(one.now)
    assert one.now.left_foot.total == 0.0
    assert one.joint("LShoulderRoll") == pytest.approx(1.2, abs=0.05)
