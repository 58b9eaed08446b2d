"""Command angles and stiffnesses: limits, the shared hip motor, limp joints."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.joints import STICTION, JointCommands

MODEL = load_model()
DT = 0.01
YAW = MODEL.joint_index["HeadYaw"]
ELBOW = MODEL.joint_index["LElbowRoll"]
LEFT, RIGHT = (MODEL.joint_index[name] for name in JointCommands.COUPLED)


@pytest.fixture
def joints():
    made = JointCommands(MODEL, [0.0] * 26)
    made.changed = False
    return made


def test_a_new_robot_is_limp_where_it_was_put():
    angles = [0.01 * i for i in range(26)]
    joints = JointCommands(MODEL, angles)
    assert joints.commands == joints.rests == tuple(angles)
    assert joints.stiffnesses == joints.velocities == (0.0,) * 26
    assert joints.changed


@pytest.mark.parametrize("angle, clamped", [(9.0, -0.0349066), (-9.0, -1.54462), (-1.0, -1.0)])
def test_angles_are_kept_within_the_limits(joints, angle, clamped):
    assert joints.clamp(ELBOW, angle) == pytest.approx(clamped)


def test_a_step_takes_a_command_no_further_than_the_motor_can(joints):
    joints.step({YAW: 2.0}, DT)
    reach = MODEL.joints[YAW].max_velocity * DT
    assert joints.commands[YAW] == pytest.approx(reach)
    assert joints.velocities[YAW] == pytest.approx(MODEL.joints[YAW].max_velocity)
    joints.step({YAW: -2.0}, DT)
    assert joints.commands[YAW] == pytest.approx(0.0)


def test_a_step_within_reach_arrives_and_then_rests(joints):
    joints.step({YAW: 0.05}, DT)
    assert joints.commands[YAW] == 0.05
    assert joints.velocities[YAW] == pytest.approx(5.0)
    joints.changed = False
    joints.step({}, DT)
    assert joints.velocities == (0.0,) * 26
    assert joints.changed
    joints.changed = False
    joints.step({}, DT)
    assert not joints.changed


def test_others_stay_where_they_are(joints):
    before = joints.commands
    joints.step({YAW: 0.05}, DT)
    assert [i for i in range(26) if joints.commands[i] != before[i]] == [YAW]


@pytest.mark.parametrize("wanted", [LEFT, RIGHT])
def test_either_hip_yaw_pitch_moves_both(joints, wanted):
    joints.step({wanted: -0.03}, DT)
    assert joints.commands[LEFT] == joints.commands[RIGHT] == -0.03
    assert joints.velocities[LEFT] == joints.velocities[RIGHT] == pytest.approx(-3.0)


def test_the_left_hip_wins_when_both_are_wanted(joints):
    joints.step({RIGHT: 0.02, LEFT: -0.02}, DT)
    assert joints.commands[LEFT] == joints.commands[RIGHT] == -0.02


def test_stiffness_is_kept_from_0_to_1_and_shared_by_the_hips(joints):
    joints.set_stiffness({YAW: 7.0, ELBOW: -1.0, RIGHT: 0.4})
    assert joints.stiffnesses[YAW] == 1.0
    assert joints.stiffnesses[ELBOW] == 0.0
    assert joints.stiffnesses[LEFT] == joints.stiffnesses[RIGHT] == 0.4
    assert joints.changed


def test_published_tuples_are_replaced_and_never_changed(joints):
    commands, stiffnesses = joints.commands, joints.stiffnesses
    joints.step({YAW: 0.05}, DT)
    joints.set_stiffness({YAW: 1.0})
    assert commands[YAW] == 0.0
    assert stiffnesses[YAW] == 0.0


def test_hold_takes_measured_angles_within_the_limits(joints):
    measured = [0.5] * 26
    joints.hold(measured, [YAW, ELBOW])
    assert joints.commands[YAW] == 0.5
    assert joints.commands[ELBOW] == pytest.approx(-0.0349066)
    assert sum(command == 0.0 for command in joints.commands) == 24
    assert joints.changed


def test_a_limp_joint_gives_a_little_and_then_slides(joints):
    measured = [0.0] * 26
    measured[YAW] = STICTION / 2
    joints.slip(measured)
    assert joints.rests[YAW] == 0.0
    assert not joints.changed
    measured[YAW] = 0.3
    joints.slip(measured)
    assert joints.rests[YAW] == pytest.approx(0.3 - STICTION)
    assert joints.changed
    measured[YAW] = -0.3
    joints.slip(measured)
    assert joints.rests[YAW] == pytest.approx(-0.3 + STICTION)


def test_nothing_slides_while_all_joints_are_stiff(joints):
    joints.set_stiffness({i: 1.0 for i in range(26)})
    joints.changed = False
    joints.slip([0.3] * 26)
    assert joints.rests == (0.0,) * 26
    assert not joints.changed


def test_a_right_hip_is_overruled_only_while_the_left_is_wanted(joints):
    assert joints.overruled(RIGHT, {LEFT: 0.0, RIGHT: 0.1})
    assert not joints.overruled(RIGHT, {RIGHT: 0.1})
    assert not joints.overruled(LEFT, {LEFT: 0.0, RIGHT: 0.1})
    assert not joints.overruled(YAW, {LEFT: 0.0, YAW: 0.1})


def test_corrections_change_what_motors_are_told_and_not_the_commands(joints):
    joints.correct({YAW: 0.05}, DT)
    assert joints.commands[YAW] == 0.0
    assert joints.aims[YAW] == pytest.approx(0.05)
    assert joints.aim_velocities[YAW] == pytest.approx(0.05 / DT)
    assert joints.changed
    joints.correct({YAW: 0.05}, DT)
    assert joints.aims[YAW] == pytest.approx(0.05)
    assert joints.aim_velocities[YAW] == 0.0


def test_corrections_keep_to_the_speed_of_the_motors(joints):
    reach = MODEL.joints[YAW].max_velocity * DT
    joints.correct({YAW: 1.0}, DT)
    assert joints.aims[YAW] == pytest.approx(reach)
    joints.correct({}, DT)
    assert joints.aims[YAW] == pytest.approx(0.0)
    assert joints.aim_velocities[YAW] == pytest.approx(-MODEL.joints[YAW].max_velocity)


def test_corrected_aims_keep_to_the_limits_of_the_joint(joints):
    joints.correct({ELBOW: 0.05}, DT)
    assert joints.commands[ELBOW] == 0.0
    assert joints.aims[ELBOW] == pytest.approx(-0.0349066)


def test_motors_are_told_nothing_new_while_nothing_is_corrected(joints):
    joints.correct({}, DT)
    assert not joints.changed
    assert joints.aims is joints.commands
    assert joints.aim_velocities is joints.velocities
