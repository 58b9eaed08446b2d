"""Diagnosis effect: hot chains go to rest and stay limp until they have cooled down."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.diagnosis import SAFE_TIME, DiagnosisEffect
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
CROUCH = posture(MODEL, "Crouch")
VERY_HOT, CRITICAL, COLD = 79.0, 95.0, 40.0
# Looks a few times a second, and rests: posture, then stiffness.
SOON, RESTED = 0.2, SAFE_TIME + 0.6


def chain(name):
    return [MODEL.joint_index[joint] for joint in MODEL.chains[name]]


@pytest.fixture
def one(bench):
    return bench()


@pytest.fixture
def effect(one):
    made = DiagnosisEffect(lambda: one.robot, lambda: made.rests.append(True))
    made.rests = []
    one.simulation.after_tick.append(made)
    return made


def stiffness(one, name):
    return {one.robot.joints.stiffnesses[i] for i in chain(name)}


def test_a_very_hot_arm_goes_to_a_safe_posture_before_it_lets_go(one, effect):
    one.robot.warm_up("LElbowRoll", VERY_HOT)
    one.run(SOON)
    assert effect.disabled == {"LArm"}
    assert stiffness(one, "LArm") == {1.0}
    one.run(RESTED)
    assert stiffness(one, "LArm") == {0.0}
    assert stiffness(one, "RArm") == stiffness(one, "LLeg") == {1.0}
    assert [one.now.commands[i] for i in chain("LArm")] == pytest.approx([CROUCH[i] for i in chain("LArm")])


def test_a_critical_arm_lets_go_at_once(one, effect):
    one.robot.warm_up("RShoulderPitch", CRITICAL)
    one.run(SOON)
    assert stiffness(one, "RArm") == {0.0}


def test_a_hot_chain_stays_limp_whatever_anybody_wants_until_it_is_cold(one, effect):
    one.robot.warm_up("HeadYaw", CRITICAL)
    one.run(1.0)
    one.stiffen(1.0, "HeadYaw", "HeadPitch", "LShoulderPitch")
    one.run(SOON)
    assert stiffness(one, "Head") == {0.0}
    assert stiffness(one, "LArm") == {1.0}
    one.robot.warm_up("HeadYaw", COLD)
    one.run(SOON)
    assert effect.disabled == frozenset()
    assert stiffness(one, "Head") == {0.0}  # somebody has to ask for it
    one.stiffen(1.0, "HeadYaw", "HeadPitch")
    assert stiffness(one, "Head") == {1.0}


def test_very_hot_legs_crouch_and_the_whole_robot_rests(one, effect):
    one.robot.warm_up("LKneePitch", VERY_HOT)
    one.run(RESTED)
    assert effect.disabled == {"Legs"}
    assert effect.rests == [True]
    assert set(one.robot.joints.stiffnesses) == {0.0}
    assert one.joint("LKneePitch") == pytest.approx(CROUCH[MODEL.joint_index["LKneePitch"]], abs=0.1)
    assert one.robot.reflexes.wake_forbidden
    one.robot.warm_up("LKneePitch", COLD)
    one.run(SOON)
    assert not one.robot.reflexes.wake_forbidden


def test_switched_off_it_only_watches_and_sees_when_it_is_switched_on(one, effect):
    one.robot.reflexes.diagnosis_enabled = False
    one.robot.warm_up("RWristYaw", CRITICAL)
    one.run(SOON)
    assert effect.disabled == frozenset()
    assert stiffness(one, "RArm") == {1.0}
    one.robot.reflexes.diagnosis_enabled = True
    one.run(SOON)
    assert effect.disabled == {"RArm"}


def test_a_new_robot_is_cold(one, effect):
    one.robot.warm_up("HeadYaw", CRITICAL)
    one.run(SOON)
    one.simulation.reset()
    one.run(SOON)
    assert effect.disabled == frozenset()
