"""ALMotion's whole body control over the network."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.postures import load_postures

TORSO, WORLD, ROBOT = 0, 1, 2
POSITION, ALL = 7, 63


def transform(robot, name):
    return np.reshape(robot.ALMotion.getTransform(name, WORLD, True), (4, 4))


def shifted(pose, *by):
    moved = pose.copy()
    moved[:3, 3] += by
    return moved.ravel().tolist()


def tilt(robot):
    roll, pitch, _ = robot.now.imu.angles
    return max(abs(roll), abs(pitch))


@pytest.fixture
def balanced(stiff_robot):
    """A robot in StandInit under whole body control."""
    motion = stiff_robot.ALMotion
    posture = load_postures().by_name["StandInit"].angles.tolist()
    stiff_robot.finish("ALMotion", "angleInterpolation", "Body", posture, 1.5, True, after=2.0)
    motion.wbEnable(True)
    return stiff_robot


def test_a_kick_as_programs_do_it(balanced):
    motion = balanced.ALMotion
    motion.wbFootState("Fixed", "Legs")
    motion.wbEnableBalanceConstraint(True, "Legs")
    assert balanced.finish("ALMotion", "wbGoToBalance", "LLeg", 1.5, after=1.6) is True
    motion.wbFootState("Free", "RLeg")
    start = transform(balanced, "RLeg")
    path = [shifted(start, -0.04, 0.0, 0.04), shifted(start, 0.05, 0.0, 0.04), shifted(start, 0.0, 0.0, 0.0)]
    kick = balanced.post("ALMotion", "transformInterpolations", "RLeg", WORLD, path, ALL, [1.0, 1.5, 3.0])
    balanced.handed_over("ALMotion")
    balanced.advance(1.5)
    assert balanced.now.right_foot.total == 0.0
    assert transform(balanced, "RLeg")[:3, 3] - start[:3, 3] == pytest.approx([0.05, 0.0, 0.04], abs=0.01)
    balanced.advance(1.6)
    balanced.answer(kick)
    assert transform(balanced, "RLeg")[:3, 3] == pytest.approx(start[:3, 3], abs=0.005)
    assert tilt(balanced) < 0.15
    motion.wbEnableEffectorOptimization("RLeg", False)
    assert balanced.finish("ALMotion", "wbGoToBalanceWithSpeed", "Legs", 1.0, after=2.0) is True
    assert balanced.now.right_foot.total > 15.0


def test_a_place_out_of_reach_is_answered_with_false(stiff_robot):
    stiff_robot.ALMotion.wbEnable(True)
    assert stiff_robot.finish("ALMotion", "wbGoToBalance", "LLeg", 1.0, after=0.5) is False


def test_an_arm_goes_where_it_is_sent_and_the_body_helps(balanced):
    motion = balanced.ALMotion
    motion.wbEnable(False)
    before = motion.getPosition("LArm", ROBOT, True)[:3]
    alone = motion.getPosition("Torso", ROBOT, True)
    motion.wbEnableEffectorControl("LArm", True)
    target = [before[0] + 0.15, before[1] + 0.02, before[2]]
    motion.wbSetEffectorControl("LArm", target)
    balanced.advance(3.0)
    assert motion.getPosition("LArm", ROBOT, True)[:3] == pytest.approx(target, abs=0.006)
    assert np.abs(np.subtract(motion.getPosition("Torso", ROBOT, True), alone)).max() > 0.02
    assert tilt(balanced) < 0.7
    motion.wbEnableEffectorControl("LArm", False)


def test_the_head_leans_by_the_whole_body(balanced):
    motion = balanced.ALMotion
    motion.wbEnableEffectorControl("Head", True)
    motion.wbSetEffectorControl("Head", [0.15, 0.0, 0.3])
    balanced.advance(3.0)
    assert motion.getPosition("Head", ROBOT, True)[3:] == pytest.approx([0.15, 0.0, 0.3], abs=0.02)


def test_targets_in_the_world_are_reached_by_the_whole_body(balanced):
    motion = balanced.ALMotion
    target = motion.getPosition("RArm", WORLD, True)
    target[0], target[2] = target[0] + 0.1, target[2] + 0.05
    motion.setPositions("RArm", WORLD, target, 0.5, POSITION)
    balanced.advance(2.0)
    assert motion.getPosition("RArm", WORLD, True)[:3] == pytest.approx(target[:3], abs=0.006)


def test_a_killed_path_ends_where_it_is(balanced):
    motion = balanced.ALMotion
    start = transform(balanced, "LArm")
    path = balanced.post("ALMotion", "transformInterpolations", "LArm", WORLD, [shifted(start, 0.1, 0, 0.1)], 7, [2.0])
    balanced.handed_over("ALMotion")
    balanced.advance(1.0)
    motion.killAll()
    balanced.answer(path)
    balanced.advance(0.3)
    stopped = transform(balanced, "LArm")[:3, 3]
    balanced.advance(1.0)
    assert transform(balanced, "LArm")[:3, 3] == pytest.approx(stopped, abs=0.003)
    assert stopped[0] - start[0, 3] < 0.08


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("wbFootState", ("Fixd", "Legs"), "did you mean 'Fixed'"),
        ("wbFootState", ("Fixed", "Leg"), "support leg 'Leg'"),
        ("wbEnableBalanceConstraint", (True, "Arms"), "unknown support leg"),
        ("wbGoToBalance", ("LLeg", -1.0), "duration is -1.0"),
        ("wbGoToBalanceWithSpeed", ("LLeg", 2.0), "fractionMaxSpeed is 2.0"),
        ("wbEnableEffectorControl", ("LLeg", True), "unknown effector"),
        ("wbEnableEffectorOptimization", ("Arm", True), "unknown effector"),
        ("wbSetEffectorControl", ("Head", [0.0, 0.0]), "wx, wy, wz in rad"),
        ("wbSetEffectorControl", ("Head", [0.0, 0.0, 0.0]), "call wbEnableEffectorControl"),
    ],
)
def test_wrong_arguments_name_what_is_allowed(stiff_robot, method, arguments, message):
    stiff_robot.ALMotion.wbEnable(True)
    with pytest.raises(RuntimeError, match=message):
        getattr(stiff_robot.ALMotion, method)(*arguments)


def test_nothing_works_while_it_is_off(stiff_robot):
    with pytest.raises(RuntimeError, match=r"call wbEnable\(True\) before"):
        stiff_robot.ALMotion.wbFootState("Fixed", "Legs")
