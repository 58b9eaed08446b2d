"""Command angles and stiffnesses: limits, the shared hip motor, coupled limits, limp joints, corrections."""

from __future__ import annotations

import pytest

from nao_sim_bridge.body.joint_commands import STICTION, JointCommands
from nao_sim_bridge.model.model_reader import load_model

MODEL = load_model()
DT = 0.01
YAW, ELBOW = (MODEL.joint_index[name] for name in ("HeadYaw", "LElbowRoll"))
LEFT, RIGHT = (MODEL.joint_index[name] for name in JointCommands.COUPLED)
TOP = MODEL.joints[YAW].max_velocity
LEAST_BEND = -0.0349066


@pytest.fixture
def joints():
    made = JointCommands(MODEL, [0.0] * 26)
    made.changed = False
    return made


def step(joints, wanted):
    """One step; whether it changed what motors are told."""
    joints.changed = False
    joints.step(wanted, DT)
    return joints.changed


def test_a_new_robot_is_limp_where_it_was_put():
    angles = tuple(0.01 * i for i in range(26))
    joints = JointCommands(MODEL, list(angles))
    assert joints.commands == joints.rests == angles
    assert joints.stiffnesses == joints.velocities == (0.0,) * 26 and joints.changed


def test_a_step_takes_a_command_no_further_than_the_motor_can_and_others_stay(joints):
    before = joints.commands
    joints.step({YAW: 2.0}, DT)
    assert (joints.commands[YAW], joints.velocities[YAW]) == pytest.approx((TOP * DT, TOP))
    assert [i for i in range(26) if joints.commands[i] != before[i]] == [YAW] and before[YAW] == 0.0
    joints.step({YAW: -2.0}, DT)
    assert joints.commands[YAW] == pytest.approx(0.0)
    joints.step({YAW: 0.05}, DT)
    assert (joints.commands[YAW], joints.velocities[YAW]) == (0.05, pytest.approx(5.0))
    assert step(joints, {}) and joints.velocities == (0.0,) * 26
    assert not step(joints, {})


def test_the_two_hips_are_one_motor_and_the_left_one_wins(joints):
    for wanted, angle in (({LEFT: -0.03}, -0.03), ({RIGHT: -0.06}, -0.06), ({RIGHT: -0.03, LEFT: -0.07}, -0.07)):
        before = joints.commands[LEFT]
        joints.step(wanted, DT)
        assert joints.commands[LEFT] == joints.commands[RIGHT] == angle
        assert joints.velocities[LEFT] == joints.velocities[RIGHT] == pytest.approx((angle - before) / DT)
    both = {LEFT: 0.0, RIGHT: 0.1, YAW: 0.1}
    assert [joints.overruled(joint, both) for joint in (RIGHT, LEFT, YAW)] == [True, False, False]
    assert not joints.overruled(RIGHT, {RIGHT: 0.1})


def test_stiffness_is_kept_from_0_to_1_and_shared_by_the_hips(joints):
    before = joints.stiffnesses
    joints.set_stiffness({YAW: 7.0, ELBOW: -1.0, RIGHT: 0.4})
    assert [joints.stiffnesses[joint] for joint in (YAW, ELBOW, LEFT, RIGHT)] == [1.0, 0.0, 0.4, 0.4]
    assert joints.changed and before == (0.0,) * 26


def test_angles_are_kept_within_the_limits(joints):
    assert [joints.clamp(ELBOW, angle) for angle in (9.0, -9.0, -1.0)] == pytest.approx([LEAST_BEND, -1.54462, -1.0])
    joints.hold([0.5] * 26, [YAW, ELBOW])
    assert (joints.commands[YAW], joints.commands[ELBOW]) == (0.5, pytest.approx(LEAST_BEND))
    assert sum(command == 0.0 for command in joints.commands) == 24 and joints.changed


def test_a_limp_joint_gives_a_little_and_then_slides_and_a_stiff_one_does_not(joints):
    measured, found = [0.0] * 26, []
    for angle in (STICTION / 2, 0.3, -0.3):
        measured[YAW], joints.changed = angle, False
        joints.slip(measured)
        found.append((joints.rests[YAW], joints.changed))
    assert found == [(0.0, False), (pytest.approx(0.3 - STICTION), True), (pytest.approx(-0.3 + STICTION), True)]
    stiff = JointCommands(MODEL, [0.0] * 26)
    stiff.set_stiffness({i: 1.0 for i in range(26)})
    stiff.changed = False
    stiff.slip([0.3] * 26)
    assert stiff.rests == (0.0,) * 26 and not stiff.changed


def test_corrections_change_what_motors_are_told_and_not_the_commands(joints):
    joints.correct({}, DT)
    assert not joints.changed and joints.aims is joints.commands and joints.aim_velocities is joints.velocities
    joints.correct({YAW: 0.05, ELBOW: 0.05}, DT)
    assert joints.changed and joints.commands == (0.0,) * 26
    assert (joints.aims[YAW], joints.aim_velocities[YAW]) == pytest.approx((0.05, 0.05 / DT))
    assert joints.aims[ELBOW] == pytest.approx(LEAST_BEND), "within the limits of the joint"
    joints.correct({YAW: 0.05}, DT)
    assert (joints.aims[YAW], joints.aim_velocities[YAW]) == (pytest.approx(0.05), 0.0)
    joints.correct({YAW: 1.0}, DT)
    assert joints.aims[YAW] == pytest.approx(0.05 + TOP * DT), "no faster than the motor"
    joints.correct({YAW: -1.0}, DT)
    assert joints.aim_velocities[YAW] == pytest.approx(-TOP)
