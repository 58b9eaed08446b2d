"""ALRobotModel and ALRobotPose over the network."""

from __future__ import annotations

from xml.etree import ElementTree

from nao_sim_bridge.services.robot_model import ALRobotModel


def preferences(text):
    return {e.get("memoryName"): e.get("value") for e in ElementTree.fromstring(text).iter() if e.get("memoryName")}


def test_the_configuration_is_what_memory_has(robot):
    found = preferences(robot.ALRobotModel.getConfig())
    assert found["RobotConfig/Body/Version"] == "6.0.0"
    assert len(found) > 15
    assert all(robot.ALMemory.getData(key) == value for key, value in found.items())


def test_versions_differ():
    assert preferences(ALRobotModel("V5").getConfig())["RobotConfig/Body/Version"] == "5.0.0"


def test_the_pose_and_how_long_it_lasts(stiff_robot):
    stiff_robot.advance(1.0)
    pose, before = stiff_robot.ALRobotPose.getActualPoseAndTime()
    assert pose == "Stand"
    stiff_robot.advance(1.0)
    assert abs(stiff_robot.ALRobotPose.getActualPoseAndTime()[1] - before - 1.0) < 0.02
    stiff_robot.finish("ALMotion", "rest", after=4.0)
    pose, since = stiff_robot.ALRobotPose.getActualPoseAndTime()
    assert pose == "Crouch"
    assert 0.0 < since < 4.0
    assert {"Stand", "Crouch", "Belly", "Unknown"} <= set(stiff_robot.ALRobotPose.getPoseNames())
