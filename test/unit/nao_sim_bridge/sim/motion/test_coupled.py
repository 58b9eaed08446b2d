"""Coupled limits: the fast tables agree with the model, and commands obey them in every way they can be broken."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.coupled import couplings
from nao_sim_bridge.sim.motion.joints import JointCommands

MODEL = load_model()
DT = 0.01
YAW, PITCH = MODEL.joint_index["HeadYaw"], MODEL.joint_index["HeadPitch"]
ANKLE_PITCH, ANKLE_ROLL = MODEL.joint_index["LAnklePitch"], MODEL.joint_index["LAnkleRoll"]


@pytest.fixture
def joints():
    return JointCommands(MODEL, [0.0] * 26)


def drive(joints, wanted, seconds=1.0):
    for _ in range(round(seconds / DT)):
        joints.step(wanted, DT)


def pitch_limits(yaw):
    return MODEL.coupled_limits["HeadPitch"].limits_at(yaw)


def test_the_fast_tables_are_those_of_the_model():
    found = couplings(MODEL)
    assert {MODEL.joints[c.joint].name for c in found} == {"HeadPitch", "LAnkleRoll", "RAnkleRoll"}
    for coupling in found:
        slow = MODEL.coupled_limits[MODEL.joints[coupling.joint].name]
        for k in range(-60, 61):
            assert coupling.limits_at(0.05 * k) == pytest.approx(slow.limits_at(0.05 * k))


def test_a_head_that_looks_aside_nods_less(joints):
    drive(joints, {YAW: 1.5, PITCH: 0.5})
    assert joints.commands[PITCH] == pytest.approx(pitch_limits(1.5)[1])
    assert joints.commands[PITCH] < 0.25


def test_a_nodding_head_is_raised_when_it_turns(joints):
    drive(joints, {PITCH: 0.5})
    assert joints.commands[PITCH] == 0.5
    drive(joints, {YAW: 1.5})
    assert joints.commands[PITCH] == pytest.approx(pitch_limits(1.5)[1])


def test_the_limit_opens_again_for_who_still_wants_it(joints):
    drive(joints, {YAW: 1.5, PITCH: 0.5})
    drive(joints, {YAW: 0.0, PITCH: 0.5})
    assert joints.commands[PITCH] == 0.5


def test_limits_of_a_joint_are_those_beside_the_others(joints):
    drive(joints, {YAW: -1.5})
    assert joints.limits(PITCH) == pytest.approx(pitch_limits(-1.5))
    assert joints.clamp(PITCH, 2.0) == pytest.approx(pitch_limits(-1.5)[1])
    assert joints.limits(YAW) == joints.limits_alone(YAW)


def test_a_joint_leaves_a_limit_that_moved_no_faster_than_its_motor_and_all_the_way(joints):
    """The ankle pitches faster than its roll can follow; the roll goes on when nobody asks for anything any more."""
    drive(joints, {ANKLE_ROLL: 0.7})
    top = MODEL.joints[ANKLE_ROLL].max_velocity
    before = joints.commands[ANKLE_ROLL]
    lagged = False
    for _ in range(19):  # as long as the pitch takes
        joints.step({ANKLE_PITCH: -1.18}, DT)
        assert abs(joints.commands[ANKLE_ROLL] - before) <= top * DT + 1e-12
        before = joints.commands[ANKLE_ROLL]
        lagged |= before > joints.limits(ANKLE_ROLL)[1] + 1e-6
    assert joints.commands[ANKLE_PITCH] == -1.18
    assert lagged
    drive(joints, {})
    assert joints.commands[ANKLE_ROLL] == pytest.approx(joints.limits(ANKLE_ROLL)[1])
    joints.changed = False
    joints.step({}, DT)
    joints.changed = False
    joints.step({}, DT)
    assert not joints.changed
