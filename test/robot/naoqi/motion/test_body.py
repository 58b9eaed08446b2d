"""What ALMotion tells about the body, Cartesian control, collisions, whole body control and idling."""

import numpy as np
import pytest

from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures

MODEL = load_model()
TORSO, WORLD, ROBOT = 0, 1, 2
POSITION, ALL = 7, 63
ARM = ["LShoulderPitch", "LShoulderRoll", "LElbowYaw", "LElbowRoll"]
CHEST = [0.8, -0.3, -0.3, -1.5]
"""The left forearm across, and into, the chest."""


def test_names_limits_cycle_and_configuration_of_the_body(robot, motion):
    for name, expected in (
        ("Head", ["HeadYaw", "HeadPitch"]),
        ("Body", [joint.name for joint in MODEL.joints]),
        ("Legs", [*MODEL.chains["LLeg"], *MODEL.chains["RLeg"]]),
        ("Chains", ["Head", "LArm", "LLeg", "RLeg", "RArm"]),
    ):
        assert motion.getBodyNames(name) == motion.getJointNames(name) == expected
    joint = MODEL.joint("LElbowRoll")
    expected = [joint.lower, joint.upper, joint.max_velocity, joint.max_torque]
    assert motion.getLimits("LElbowRoll") == [pytest.approx(expected)] and len(motion.getLimits("Body")) == 26
    assert motion.getMotionCycleTime() == pytest.approx(1000 * robot.server.simulation.settings.tick_s, abs=0.5)
    config = dict(zip(*motion.getRobotConfig()))
    assert (config["Model Type"], config["Number of Legs"], config["Number of Hands"]) == ("naoH25", 2, 2)
    assert config["Head Version"] == config["Body Version"] == "VERSION_60"


def test_places_of_the_body_agree(robot, motion):
    pose, position = (motion.call(f"get{what}", "LArm", ROBOT, True) for what in ("Transform", "Position"))
    assert len(pose) == 16 and [pose[3], pose[7], pose[11]] == pytest.approx(position[:3])
    x, y, z = motion.getCOM("Body", ROBOT, True)
    corners = motion.getSupportPolygon(ROBOT, True)
    assert min(c[0] for c in corners) < x < max(c[0] for c in corners)
    assert y == pytest.approx(0.0, abs=0.01) and 0.2 < z < 0.35
    assert motion.getMass("Body") == pytest.approx(robot.server.simulation.model.total_mass)
    feet = [motion.getPosition(name, WORLD, True) for name in ("LLeg", "RLeg")]
    assert [sum(both) / 2 for both in zip(*feet)] == pytest.approx([0.0] * 6, abs=0.01)


def test_a_hand_is_where_its_arm_ends(motion):
    for side in "LR":
        assert motion.getPosition(f"{side}Hand", TORSO, True) == motion.getPosition(f"{side}Arm", TORSO, True)


@pytest.mark.parametrize("space", [TORSO, WORLD, ROBOT])
def test_a_hand_goes_where_it_is_sent(stiff_robot, motion, space):
    target = motion.getPosition("LArm", space, True)
    target[0], target[2] = target[0] + 0.03, target[2] + 0.04
    motion.setPositions("LArm", space, target, 0.5, POSITION)
    stiff_robot.advance(2.0)
    assert motion.getPosition("LArm", space, True)[:3] == pytest.approx(target[:3], abs=0.006)
    if space == TORSO:
        change = [0.0, 0.0, -0.04, 0.0, 0.0, 0.0]
        path = ("positionInterpolation", "LArm", TORSO, change, POSITION, [1.0], False)
        stiff_robot.finish("ALMotion", *path, after=1.1)
        target[2] -= 0.04
        assert motion.getPosition("LArm", TORSO, True)[:3] == pytest.approx(target[:3], abs=0.006)


def test_the_torso_moves_over_feet_that_stay(stiff_robot, motion):
    def feet():
        return sum((motion.getPosition(name, WORLD, True)[:3] for name in ("LLeg", "RLeg")), [])

    stiff_robot.advance(0.5)
    stood, before, change = feet(), motion.getPosition("Torso", WORLD, True), [0.01, 0.02, -0.03, 0.0, 0.0, 0.0]
    stiff_robot.finish("ALMotion", "positionInterpolation", "Torso", WORLD, change, 63, [1.5], False, after=1.7)
    moved = np.subtract(motion.getPosition("Torso", WORLD, True), before)
    assert moved[:3] == pytest.approx(change[:3], abs=0.005) and feet() == pytest.approx(stood, abs=0.005)


def test_an_arm_stops_short_of_the_chest_unless_its_protection_is_off(stiff_robot, motion):
    def into_the_chest():
        stiff_robot.finish("ALMotion", "angleInterpolation", ARM, [[angle] for angle in CHEST], 1.0, True, after=1.1)
        return motion.getAngles("LElbowRoll", False)[0]

    def protected():
        return [motion.getCollisionProtectionEnabled(name) for name in ("LArm", "RArm", "Arms")]

    assert motion.isCollision("Arms") == "none" and protected() == [True, True, True]
    assert into_the_chest() > CHEST[-1] + 0.1
    assert [motion.isCollision(name) for name in ("LArm", "RArm", "Arms")] == ["near", "none", "near"]
    assert motion.setCollisionProtectionEnabled("LArm", False) and protected() == [False, True, False]
    assert into_the_chest() == pytest.approx(CHEST[-1]) and motion.isCollision("Arms") == "collision"
    # Where it is, it has protection or not; it cannot lose it.
    assert motion.setCollisionProtectionEnabled("LArm", True)
    assert motion.setCollisionProtectionEnabled("Arms", False) is False and protected()[0] is True


@pytest.fixture
def balanced(stiff_robot, motion):
    """A robot in StandInit under whole body control."""
    posture = load_postures().by_name["StandInit"].angles.tolist()
    stiff_robot.finish("ALMotion", "angleInterpolation", "Body", posture, 1.5, True, after=2.0)
    motion.wbEnable(True)
    return stiff_robot


def transform(robot, name):
    return np.reshape(robot.ALMotion.getTransform(name, WORLD, True), (4, 4))


def shifted(pose, *by):
    moved = pose.copy()
    moved[:3, 3] += by
    return moved.ravel().tolist()


def tilt(robot):
    roll, pitch, _ = robot.now.imu.angles
    return max(abs(roll), abs(pitch))


def test_a_kick_as_programs_do_it(balanced, motion, begin):
    motion.wbFootState("Fixed", "Legs")
    motion.wbEnableBalanceConstraint(True, "Legs")
    assert balanced.finish("ALMotion", "wbGoToBalance", "LLeg", 1.5, after=1.6) is True
    motion.wbFootState("Free", "RLeg")
    start = transform(balanced, "RLeg")
    path = [shifted(start, -0.04, 0.0, 0.04), shifted(start, 0.05, 0.0, 0.04), shifted(start, 0.0, 0.0, 0.0)]
    kick = begin("ALMotion", "transformInterpolations", "RLeg", WORLD, path, ALL, [1.0, 1.5, 3.0], after=1.5)
    assert balanced.now.right_foot.total == 0.0
    assert transform(balanced, "RLeg")[:3, 3] - start[:3, 3] == pytest.approx([0.05, 0.0, 0.04], abs=0.01)
    balanced.advance(1.6)
    balanced.answer(kick)
    assert transform(balanced, "RLeg")[:3, 3] == pytest.approx(start[:3, 3], abs=0.005) and tilt(balanced) < 0.15
    assert balanced.finish("ALMotion", "wbGoToBalanceWithSpeed", "Legs", 1.0, after=2.0) is True
    assert balanced.now.right_foot.total > 15.0


def test_an_arm_goes_where_it_is_sent_and_the_body_helps(balanced, motion):
    motion.wbEnable(False)
    before, alone = (motion.getPosition(name, ROBOT, True) for name in ("LArm", "Torso"))
    motion.wbEnableEffectorControl("LArm", True)
    target = [before[0] + 0.15, before[1] + 0.02, before[2]]
    motion.wbSetEffectorControl("LArm", target)
    balanced.advance(3.0)
    assert motion.getPosition("LArm", ROBOT, True)[:3] == pytest.approx(target, abs=0.006)
    assert np.abs(np.subtract(motion.getPosition("Torso", ROBOT, True), alone)).max() > 0.02 and tilt(balanced) < 0.7


def test_balance_out_of_reach_and_what_cannot_be(stiff_robot, motion, refuses):
    refuses("ALMotion", r"""
        wbFootState('Fixed', 'Legs') -> call wbEnable\(True\) before
        getPosition('LArn', 0, True) -> did you mean 'LArm'
        setPositions('LArm', 0, [0.0] * 6, 0.5, 64) -> axisMask is 64
        setBreathConfig([['Bpm', 50.0]]) -> Bpm is 50.0, allowed is 5 to 30
        setBreathConfig([['Bmp', 10.0]]) -> did you mean 'Bpm'
    """)  # fmt: skip
    motion.wbEnable(True)
    assert stiff_robot.finish("ALMotion", "wbGoToBalance", "LLeg", 1.0, after=0.5) is False
    refuses("ALMotion", """
        wbEnableEffectorControl('LLeg', True) -> unknown effector
        wbSetEffectorControl('Head', [0.0, 0.0]) -> wx, wy, wz in rad
        wbSetEffectorControl('Head', [0.0, 0.0, 0.0]) -> call wbEnableEffectorControl
    """)  # fmt: skip


def test_a_robot_breathes_when_it_is_told_to_and_stops(stiff_robot, motion):
    motion.setBreathEnabled("Arms", True)
    assert motion.getBreathEnabled("LArm") and not motion.getBreathEnabled("Body")
    stiff_robot.advance(3.0)
    before = motion.getAngles("Body", True)
    stiff_robot.advance(1.5)
    moved = np.abs(np.subtract(motion.getAngles("Body", True), before)) > 0.01
    names = [name for name, has in zip(motion.getBodyNames("Body"), moved) if has]
    assert {"LElbowRoll", "RElbowRoll", "LShoulderPitch"} <= set(names)
    assert not any("Head" in name or "Knee" in name for name in names)
    motion.setBreathEnabled("Arms", False)
    stiff_robot.advance(0.1)
    stopped = motion.getAngles("Body", False)
    stiff_robot.advance(1.0)
    assert motion.getAngles("Body", False) == pytest.approx(stopped)
    assert motion.getBreathConfig() == [["Bpm", 12.0], ["Amplitude", 0.5]]
    motion.setBreathConfig([["Bpm", 30.0], ["Amplitude", 1.0]])  # as fast as this, breaths are as flat as can be
    assert motion.getBreathConfig() == [["Bpm", 30.0], ["Amplitude", 0.0]]


def test_a_head_goes_back_to_the_posture_and_the_last_call_decides(stiff_robot, motion):
    motion.setBreathEnabled("Head", True)
    motion.setIdlePostureEnabled("Head", True)
    assert motion.getIdlePostureEnabled("Head") and not motion.getBreathEnabled("Head")
    stiff_robot.finish("ALMotion", "angleInterpolation", "HeadYaw", 0.6, 0.5, True, after=0.51)
    assert motion.getAngles("HeadYaw", False) == pytest.approx([0.6], abs=0.02)
    stiff_robot.advance(3.0)
    assert motion.getAngles("HeadYaw", True) == pytest.approx([0.0], abs=0.02)
    motion.setIdlePostureEnabled("Head", False)
    assert not motion.getIdlePostureEnabled("Head")
