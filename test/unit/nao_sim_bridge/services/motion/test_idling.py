"""ALMotion's idle control over the network: breathing and idle posture."""

from __future__ import annotations

import pytest


@pytest.fixture
def motion(stiff_robot):
    return stiff_robot.ALMotion


def test_a_robot_breathes_when_it_is_told_to_and_stops(stiff_robot, motion):
    motion.setBreathEnabled("Arms", True)
    assert motion.getBreathEnabled("LArm") and not motion.getBreathEnabled("Body")
    stiff_robot.advance(3.0)
    before = motion.getAngles("Body", True)
    stiff_robot.advance(1.5)
    after = motion.getAngles("Body", True)
    moved = [abs(b - a) > 0.01 for a, b in zip(before, after)]
    names = [name for name, has in zip(motion.getBodyNames("Body"), moved) if has]
    assert {"LElbowRoll", "RElbowRoll", "LShoulderPitch"} <= set(names)
    assert not any("Head" in name or "Knee" in name for name in names)
    motion.setBreathEnabled("Arms", False)
    stiff_robot.advance(0.1)
    stopped = motion.getAngles("Body", False)
    stiff_robot.advance(1.0)
    assert motion.getAngles("Body", False) == pytest.approx(stopped)


def test_the_breath_is_described_by_two_numbers(robot):
    motion = robot.ALMotion
    assert motion.getBreathConfig() == [["Bpm", 12.0], ["Amplitude", 0.5]]
    motion.setBreathConfig([["Bpm", 30.0], ["Amplitude", 1.0]])
    # As fast as this, breaths are as flat as can be.
    assert motion.getBreathConfig() == [["Bpm", 30.0], ["Amplitude", 0.0]]
    motion.setBreathConfig([["Bpm", 5.0]])
    assert motion.getBreathConfig() == [["Bpm", 5.0], ["Amplitude", 0.0]]


@pytest.mark.parametrize(
    "config, message",
    [
        ([["Bpm", 50.0]], "Bpm is 50.0, allowed is 5 to 30"),
        ([["Amplitude", -1.0]], "Amplitude is -1.0"),
        ([["Bmp", 10.0]], "did you mean 'Bpm'"),
        ([[["Bpm"], 10.0]], "unknown breath parameter"),
        (["Bpm", 10.0], "pConfig"),
    ],
)
def test_a_breath_that_cannot_be_is_refused(robot, config, message):
    with pytest.raises(RuntimeError, match=message):
        robot.ALMotion.setBreathConfig(config)


def test_the_last_call_decides_between_breath_and_posture(motion):
    motion.setBreathEnabled("Head", True)
    motion.setIdlePostureEnabled("Head", True)
    assert motion.getIdlePostureEnabled("Head") and not motion.getBreathEnabled("Head")
    motion.setIdlePostureEnabled("Head", False)
    assert not motion.getIdlePostureEnabled("Head")


def test_a_head_goes_back_to_the_posture_after_a_command(stiff_robot, motion):
    motion.setIdlePostureEnabled("Head", True)
    stiff_robot.finish("ALMotion", "angleInterpolation", "HeadYaw", 0.6, 0.5, True, after=0.51)
    assert motion.getAngles("HeadYaw", False) == pytest.approx([0.6], abs=0.02)
    stiff_robot.advance(3.0)
    assert motion.getAngles("HeadYaw", True) == pytest.approx([0.0], abs=0.02)


def test_a_chain_that_cannot_idle_is_refused(robot):
    with pytest.raises(RuntimeError, match="unknown chain 'LLeg'"):
        robot.ALMotion.setBreathEnabled("LLeg", True)
