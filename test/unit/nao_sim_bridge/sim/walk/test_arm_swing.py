"""Arms that swing against the legs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.walk.arm_swing import ArmSwing
from nao_sim_bridge.sim.walk.settings import load_walk_settings

MODEL = load_model()
SETTINGS = load_walk_settings()
DT = 1.0 / 120.0
HOME = posture(MODEL, "StandInit")
LEFT, RIGHT = (MODEL.joint_index[f"{side}ShoulderPitch"] for side in "LR")
ARM = {
    side: {MODEL.joint_index[name] for name in MODEL.chains[f"{side}Arm"] if not name.endswith("Hand")} for side in "LR"
}


class Fake:
    """A robot of arms: joints that go at once where they are wanted, and legs that stride as told."""

    def __init__(self, at="StandInit"):
        self.stride = 0.0
        self.joints = JointCommands(MODEL, posture(MODEL, at))
        self.joints.set_stiffness(dict.fromkeys(range(26), 1.0))
        self.swing = ArmSwing(MODEL, self.joints, SETTINGS, lambda: self.stride)

    def after(self, seconds, busy=frozenset()):
        """What the arms are wanted to do at the last tick."""
        for _ in range(round(seconds / DT)):
            wanted = self.swing.wishes(busy, DT)
        return wanted


@pytest.fixture
def robot():
    return Fake()


def test_nobody_who_stands_swings_arms(robot):
    robot.stride = None
    assert robot.swing.wishes(frozenset(), DT) == {}


@pytest.mark.parametrize("stride", [-0.04, 0.02, 0.04])
def test_arms_go_against_the_legs(robot, stride):
    robot.stride = stride
    wanted = robot.after(2 * SETTINGS.arm_ease)
    by_stride = SETTINGS.arm_swing * stride / 0.04
    # A larger shoulder pitch points the arm further back.
    assert wanted[LEFT] == pytest.approx(HOME[LEFT] + by_stride)
    assert wanted[RIGHT] == pytest.approx(HOME[RIGHT] - by_stride)
    for index in (ARM["L"] | ARM["R"]) - {LEFT, RIGHT}:
        assert wanted[index] == pytest.approx(HOME[index])


def test_hands_and_everything_else_is_left_alone(robot):
    assert set(robot.after(1.0)) == ARM["L"] | ARM["R"]


def test_arms_join_in_without_a_jerk():
    robot = Fake("StandZero")
    robot.stride = 0.04
    before = dict(enumerate(robot.joints.commands))
    fastest = 0.0
    for _ in range(round(SETTINGS.arm_ease / DT)):
        wanted = robot.swing.wishes(frozenset(), DT)
        fastest = max(fastest, *(abs(angle - before[i]) / DT for i, angle in wanted.items()))
        before.update(wanted)
    furthest = max(abs(HOME[i] - posture(MODEL, "StandZero")[i]) for i in ARM["L"])
    assert fastest < 1.6 * (furthest + SETTINGS.arm_swing) / SETTINGS.arm_ease
    assert before[LEFT] == pytest.approx(HOME[LEFT] + SETTINGS.arm_swing)


def test_an_arm_that_somebody_moves_is_his(robot):
    robot.stride = 0.04
    robot.after(1.0)
    wanted = robot.after(1.0, busy=frozenset({MODEL.joint_index["LElbowRoll"]}))
    assert set(wanted) == ARM["R"]
    again = robot.swing.wishes(frozenset(), DT)
    assert again[LEFT] == pytest.approx(robot.joints.commands[LEFT], abs=0.01), "it joins in again from where it is"


@pytest.mark.parametrize("arm, other", [("LArm", "R"), ("RArm", "L")])
def test_an_arm_that_may_not_swing_does_not(robot, arm, other):
    robot.swing.enabled[arm] = False
    assert set(robot.after(1.0)) == ARM[other]


def test_a_limp_arm_does_not_swing(robot):
    robot.joints.set_stiffness({MODEL.joint_index["RElbowYaw"]: 0.0})
    assert set(robot.after(1.0)) == ARM["L"]


def test_what_else_moves_idle_joints_goes_on_beneath(robot):
    head = MODEL.joint_index["HeadYaw"]

    class Breathing:
        def wishes(self, busy, dt):
            return {head: 0.3, LEFT: 0.0}

    robot.swing.over(Breathing())
    wanted = robot.after(2 * SETTINGS.arm_ease)
    assert wanted[head] == 0.3
    assert wanted[LEFT] == pytest.approx(HOME[LEFT]), "the swing comes first"
    robot.stride = None
    assert robot.swing.wishes(frozenset(), DT) == {head: 0.3, LEFT: 0.0}


def test_how_far_arms_swing_is_a_setting(robot):
    still = ArmSwing(MODEL, robot.joints, replace(SETTINGS, arm_swing=0.0), lambda: 0.04)
    for _ in range(120):
        wanted = still.wishes(frozenset(), DT)
    assert wanted[LEFT] == pytest.approx(HOME[LEFT])
