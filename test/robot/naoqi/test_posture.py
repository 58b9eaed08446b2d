"""ALRobotPosture, ALRobotPose, ALRobotModel: changes of posture, what they answer, and the events about them."""

from xml.etree import ElementTree

import pytest

from nao_sim_bridge.naoqi.body.robot_model import ALRobotModel

POSTURE = "ALRobotPosture"
NAMES = ["Crouch", "LyingBack", "LyingBelly", "Sit", "SitRelax", "Stand", "StandInit", "StandZero"]
FAMILIES = "Standing Crouching Sitting SittingOnChair LyingBelly LyingBack LyingLeft LyingRight".split()


def test_it_goes_to_a_posture_wakes_the_robot_and_tells_the_change(robot, begin, listener):
    posture, memory = robot.ALRobotPosture, robot.ALMemory
    assert (posture.getPostureList(), posture.getPostureFamilyList()) == (NAMES, FAMILIES)
    assert robot.ALMotion.robotIsWakeUp() is False and posture.stopMove() is None
    assert robot.finish(POSTURE, "goToPosture", "StandInit", 1.0, after=3.0) is True
    assert robot.ALMotion.robotIsWakeUp() and robot.ALMotion.getStiffnesses("Body") == [1.0] * 26
    robot.advance(1.0)
    assert (memory.getData("PostureChanged"), memory.getData("PostureFamilyChanged")) == ("StandInit", "Standing")
    for event in ("PostureChanged", "PostureFamilyChanged", "Test/Last"):
        memory.subscribeToEvent(event, "Listener", "onEvent")
    robot.advance(1.0)
    future = begin(POSTURE, "goToPosture", "Crouch", 1.0, after=0.5)
    assert [name for name, _ in robot.ALMotion.getTaskList()] == ["goToPosture"]
    robot.advance(2.5)
    assert robot.answer(future) is True
    memory.raiseEvent("Test/Last", 0)
    assert listener.until("Test/Last") == {"PostureChanged": "Crouch", "PostureFamilyChanged": "Crouching"}
    assert (posture.getPosture(), posture.getPostureFamily()) == ("Crouch", "Crouching")


@pytest.mark.parametrize("end", ["killAll", "stopMove", "cancel"])
def test_a_change_can_be_ended(stiff_robot, begin, end):
    future = begin(POSTURE, "goToPosture", "Crouch", 0.3, after=1.0)
    if end == "cancel":
        future.cancel()
        stiff_robot.handed_over(POSTURE)
        assert future.wait(5000) and future.isCanceled()
    else:
        (stiff_robot.ALMotion if end == "killAll" else stiff_robot.ALRobotPosture).call(end)
        assert stiff_robot.answer(future) is False
    assert stiff_robot.ALMotion.getTaskList() == []
    before = stiff_robot.ALMotion.getAngles("Body", False)
    stiff_robot.advance(0.5)
    assert stiff_robot.ALMotion.getAngles("Body", False) == before


def test_another_motion_gives_way_and_apply_posture_wakes_nobody(robot, begin):
    assert robot.finish(POSTURE, "applyPosture", "Crouch", 1.0, after=3.0) is False
    assert robot.ALMotion.robotIsWakeUp() is False
    robot.ALMotion.setStiffnesses("Body", 1.0)
    older = begin("ALMotion", "angleInterpolation", ["HeadYaw"], [1.0], 9.0, True, after=0.5)
    assert robot.finish(POSTURE, "goToPosture", "StandInit", 1.0, after=4.0) is True
    assert older.isFinished()
    assert robot.finish(POSTURE, "applyPosture", "Crouch", 0.4, after=3.0) is True
    assert robot.ALRobotPosture.getPosture() == "Crouch"


def test_a_speed_above_1_is_the_top_speed(stiff_robot):
    durations = []
    for speed in (1.0, 5.0):
        assert stiff_robot.finish(POSTURE, "goToPosture", "Crouch", 1.0, after=4.0) is True
        began, future = stiff_robot.now.time, stiff_robot.post(POSTURE, "goToPosture", "StandInit", speed)
        stiff_robot.handed_over(POSTURE)
        stiff_robot.advance_until(lambda call=future: not call.isRunning(), 5.0, 0.05, "it stands")
        assert stiff_robot.answer(future) is True
        durations.append(stiff_robot.now.time - began)
    assert durations[1] == pytest.approx(durations[0], abs=0.2)


def test_what_is_wrong_is_named(refuses):
    refuses(POSTURE, """
        goToPosture('Standing', 0.5) -> postureName is 'Standing', allowed is one of Crouch, LyingBack
        goToPosture('Stand', 0.0) -> maxSpeedFraction is 0.0, allowed is above 0 to 1
        goToPosture('Stand', -0.5) -> maxSpeedFraction is -0.5, allowed is 0 to 1
        setMaxTryNumber(0) -> pMaxTryNumber is 0, allowed is 1 or more
    """)  # fmt: skip


def preferences(text):
    return {e.get("memoryName"): e.get("value") for e in ElementTree.fromstring(text).iter() if e.get("memoryName")}


def test_the_configuration_is_what_memory_has(robot):
    found = preferences(robot.ALRobotModel.getConfig())
    assert found["RobotConfig/Body/Version"] == "6.0.0" and len(found) > 15
    assert all(robot.value(key) == value for key, value in found.items())
    assert preferences(ALRobotModel("V5").getConfig())["RobotConfig/Body/Version"] == "5.0.0"


def test_the_pose_and_how_long_it_lasts(stiff_robot):
    stiff_robot.advance(1.0)
    pose, before = stiff_robot.ALRobotPose.getActualPoseAndTime()
    stiff_robot.advance(1.0)
    assert pose == "Stand" and stiff_robot.ALRobotPose.getActualPoseAndTime()[1] - before == pytest.approx(1, abs=0.02)
    stiff_robot.finish("ALMotion", "rest", after=4.0)
    pose, since = stiff_robot.ALRobotPose.getActualPoseAndTime()
    assert pose == "Crouch" and 0.0 < since < 4.0
    assert {"Stand", "Crouch", "Belly", "Unknown"} <= set(stiff_robot.ALRobotPose.getPoseNames())
