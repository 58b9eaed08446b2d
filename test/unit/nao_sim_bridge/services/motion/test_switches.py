"""Switches of ALMotion's reflexes over the network, and what they do."""

from __future__ import annotations

import pytest


def efforts(robot):
    return robot.server.simulation.robot.joints.efforts


def test_smart_stiffness_is_on_and_can_be_switched_off(stiff_robot):
    motion = stiff_robot.ALMotion
    assert motion.getSmartStiffnessEnabled()
    stiff_robot.advance(2.0)
    assert min(efforts(stiff_robot)) < 0.5
    assert motion.getStiffnesses("Body") == [1.0] * 26
    motion.setSmartStiffnessEnabled(False)
    stiff_robot.advance(0.1)
    assert not motion.getSmartStiffnessEnabled()
    assert min(efforts(stiff_robot)) == 1.0


def test_a_hot_knee_puts_the_robot_to_rest_and_keeps_it_there(stiff_robot):
    motion, memory = stiff_robot.ALMotion, stiff_robot.ALMemory
    warm = stiff_robot.server.simulation.robot.warm_up
    stiff_robot.finish("ALMotion", "wakeUp", after=3.0)
    stiff_robot.server.runner.call(lambda: warm("LKneePitch", 79.0))
    stiff_robot.advance(3.0)
    assert memory.getData("Device/SubDeviceList/LKneePitch/Temperature/Sensor/Status") >= 2
    assert motion.getStiffnesses("Body") == [0.0] * 26
    assert not motion.robotIsWakeUp()
    assert memory.getData("ALMotion/Protection/DisabledDevicesChanged") == [["Body", True]]
    assert memory.getData("ALMotion/Protection/DisabledFeaturesChanged") == [["LegsStiffness", True], ["Move", True]]
    with pytest.raises(RuntimeError, match="too hot"):
        motion.wakeUp()
    stiff_robot.server.runner.call(lambda: warm("LKneePitch", 40.0))
    stiff_robot.advance(0.2)
    assert memory.getData("ALMotion/Protection/DisabledDevicesChanged") == [["Body", False]]
    stiff_robot.finish("ALMotion", "wakeUp", after=3.0)
    assert motion.robotIsWakeUp()


def test_without_diagnosis_effect_nobody_rests(stiff_robot):
    motion = stiff_robot.ALMotion
    assert motion.getDiagnosisEffectEnabled()
    motion.setDiagnosisEffectEnabled(False)
    stiff_robot.server.runner.call(lambda: stiff_robot.server.simulation.robot.warm_up("HeadYaw", 79.0))
    stiff_robot.advance(3.0)
    assert motion.getStiffnesses("Head") == [1.0, 1.0]
    assert not motion.getDiagnosisEffectEnabled()


def test_notifications_are_on_and_can_be_switched_off(robot):
    motion = robot.ALMotion
    assert motion.areNotificationsEnabled()
    motion.setEnableNotifications(False)
    assert not motion.areNotificationsEnabled()


def test_named_switches_reach_the_fall_manager(robot):
    motion = robot.ALMotion
    motion.setMotionConfig([["ENABLE_FALL_MANAGER_PROTECTION", False], ["ENABLE_STIFFNESS_PROTECTION", False]])
    assert not motion.getFallManagerEnabled()
    assert not robot.server.simulation.robot.reflexes.switches["ENABLE_STIFFNESS_PROTECTION"]
    assert robot.server.simulation.robot.reflexes.switches["ENABLE_FOOT_CONTACT_PROTECTION"]


@pytest.mark.parametrize(
    "config, message",
    [
        ([["ENABLE_STIFNESS_PROTECTION", True]], "did you mean 'ENABLE_STIFFNESS_PROTECTION'"),
        ([["ENABLE_STIFFNESS_PROTECTION", 7]], "allowed is true or false"),
        ("ENABLE_STIFFNESS_PROTECTION", "pairs such as"),
    ],
)
def test_switches_that_there_are_not_are_refused(robot, config, message):
    with pytest.raises(RuntimeError, match=message):
        robot.ALMotion.setMotionConfig(config)
