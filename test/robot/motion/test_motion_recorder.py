"""ALMotionRecorder: poses that are kept in time or by touch, and that ALMotion plays."""

import numpy as np
import pytest

ARM = ["LShoulderPitch", "LElbowRoll"]


@pytest.fixture
def robot(stiff_robot):
    return stiff_robot


@pytest.fixture
def recorder(robot):
    return robot.ALMotionRecorder


def press(robot, *sensors):
    """Press sensors for a moment."""
    robot.NaoSimulation.press(list(sensors))
    robot.advance(0.1)
    robot.NaoSimulation.press([])
    robot.advance(0.1)


def test_poses_are_kept_in_time_and_play_again(robot, recorder):
    recorder.startPeriodicRecording(ARM, 8, False, 0.2, [], [])
    robot.ALMotion.setAngles("LShoulderPitch", 0.6, 0.3)
    robot.advance(2.0)
    joints, times, angles = recorder.stopAndGetRecording()
    assert joints == ARM and times[0] == times[1] == pytest.approx([0.2 * i for i in range(1, 9)], abs=0.011)
    assert angles[0][0] > 0.75 and angles[0][-1] == pytest.approx(0.6, abs=0.05)
    assert np.diff(angles[0]).max() < 0.01
    robot.ALMotion.setAngles("LShoulderPitch", 1.4, 1.0)
    robot.advance(1.0)
    robot.finish("ALMotion", "angleInterpolation", joints, angles, times, True, after=1.8)
    assert robot.ALMotion.getAngles("LShoulderPitch", True)[0] == pytest.approx(angles[0][-1], abs=0.05)


def test_joints_are_replayed_meanwhile(robot, recorder):
    bezier = [[[0.5, [3, -0.2, 0.0], [3, 0.2, 0.0]]]]
    recorder.startPeriodicRecording(["HeadYaw"], 5, True, 0.25, ["HeadYaw"], [[[1.0]], bezier])
    robot.advance(1.6)
    _, (times,), (angles,) = recorder.stopAndGetRecording()
    assert len(times) == 6 and 0.1 < angles[1] < 0.45 and angles[-1] == pytest.approx(0.5, abs=0.03)


def test_the_chest_button_keeps_a_pose(robot, recorder):
    recorder.startInteractiveRecording(["HeadYaw"], 2, False, 2)
    for yaw in (0.3, -0.3, 0.6):
        robot.ALMotion.setAngles("HeadYaw", yaw, 1.0)
        robot.advance(0.8)
        press(robot, "ChestBoard/Button")
    _, (times,), (angles,) = recorder.stopAndGetRecording()
    assert angles == pytest.approx([0.3, -0.3], abs=0.03), "two poses are wanted"
    assert np.diff(times) == pytest.approx([1.0], abs=0.05)


def test_bumpers_release_and_hold_the_joints_and_keep_a_pose(robot, recorder):
    recorder.startInteractiveRecording(ARM, 1, True, 1)
    press(robot, "RFoot/Bumper/Left")
    assert robot.ALMotion.getStiffnesses(ARM) == [0.0, 0.0] and robot.ALMotion.getStiffnesses("HeadYaw") == [1.0]
    press(robot, "RFoot/Bumper/Right")
    assert robot.ALMotion.getStiffnesses(ARM) == [1.0, 1.0]
    for _ in range(2):
        press(robot, "LFoot/Bumper/Left")
    _, times, angles = recorder.stopAndGetRecording()
    assert [len(one) for one in (*times, *angles)] == [2] * 4


def test_what_is_wrong_is_told(robot, recorder):
    recorder.startInteractiveRecording(["HeadYaw"], 2, False, 2)
    for method, arguments, words in (
        ("startInteractiveRecording", (["HeadYaw"], 2, False, 2), "a recording goes on; stopAndGetRecording ends it"),
        ("startInteractiveRecording", (["HeadYaw"], 2, False, 3), "mode is 3, allowed is one of 1, 2"),
        ("startInteractiveRecording", (["HeadJaw"], 2, False, 2), "HeadJaw"),
        ("startPeriodicRecording", (["HeadYaw"], 0, False, 0.1, [], []), "nbPoses is 0"),
        ("startPeriodicRecording", (["HeadYaw"], 1, False, 0.001, [], []), "timeStep is 0.001"),
        ("startPeriodicRecording", (["HeadYaw"], 1, False, 0.1, ["HeadYaw"], []), "times is"),
    ):
        with pytest.raises(RuntimeError, match=f"^ALMotionRecorder::{method} .*{words}"):
            recorder.call(method, *arguments)
    recorder.stopAndGetRecording()
    with pytest.raises(RuntimeError, match="nothing is recorded: startInteractiveRecording or"):
        recorder.stopAndGetRecording()
