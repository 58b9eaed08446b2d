"""ALDiagnosis: devices that fail are found, told, and kept from doing harm."""

from __future__ import annotations

import pytest

SOON = 0.25
PREFIX = "Device/SubDeviceList/"


@pytest.fixture
def fail(robot):
    def device(name):
        robot.NaoSimulation.breakDevice(name)
        robot.advance(SOON)

    return device


def test_a_healthy_robot_is_ready(robot):
    robot.advance(SOON)
    assert robot.ALDiagnosis.getDiagnosisStatus() == [0, []]
    assert robot.ALMemory.getData("ALDiagnosis/RobotIsReady") is True


def test_a_sensor_that_does_not_answer_is_found_at_once(robot, fail):
    fail("US/Left")
    assert robot.ALDiagnosis.getPassiveDiagnosis() == [0, ["US/Left"]]
    fail("InertialSensor")
    assert robot.ALDiagnosis.getPassiveDiagnosis() == [1, ["US/Left", "InertialSensor"]]
    assert robot.ALDiagnosis.getDiagnosisStatus() == [1, ["US/Left", "InertialSensor"]]
    assert robot.ALMemory.getData("PassiveDiagnosisErrorChanged") == [1, ["US/Left", "InertialSensor"]]
    assert robot.ALDiagnosis.getActiveDiagnosis() == [0, []]
    robot.NaoSimulation.repairDevice("InertialSensor")
    robot.NaoSimulation.repairDevice("US/Left")
    robot.advance(SOON)
    assert robot.ALDiagnosis.getPassiveDiagnosis() == [0, []]
    assert robot.ALMemory.getData("ALDiagnosis/DiagnosisErrorChanged") == [0, []]


@pytest.mark.parametrize(
    "device, key, least",
    [
        ("LFoot/FSR/FrontLeft", "LFoot/FSR/FrontLeft/Sensor/Value", 0.05),
        ("InertialSensor", "InertialSensor/AccelerometerZ/Sensor/Value", 9.0),
    ],
)
def test_a_broken_sensor_reads_nothing(stiff_robot, fail, device, key, least):
    stiff_robot.advance(0.5)
    assert stiff_robot.ALMemory.getData(PREFIX + key) > least
    fail(device)
    assert stiff_robot.ALMemory.getData(PREFIX + key) == 0.0
    stiff_robot.NaoSimulation.repairDevice(device)
    stiff_robot.advance(SOON)
    assert stiff_robot.ALMemory.getData(PREFIX + key) > least


def test_a_broken_touch_sensor_feels_no_finger(robot, fail):
    fail("Head/Touch/Front")
    robot.NaoSimulation.press(["Head/Touch/Front", "Head/Touch/Rear"])
    robot.advance(SOON)
    assert robot.now.touched == {"Head/Touch/Rear"}
    robot.NaoSimulation.press([])


def test_a_broken_motor_does_not_move_and_is_found_when_the_robot_wakes_up(stiff_robot, fail):
    stiff_robot.finish("ALMotion", "rest", after=3.0)
    fail("HeadYaw")
    assert stiff_robot.ALDiagnosis.getDiagnosisStatus() == [0, []]  # nobody has tried it
    stiff_robot.finish("ALMotion", "wakeUp", after=3.0)
    assert stiff_robot.ALDiagnosis.getActiveDiagnosis() == [1, ["HeadYaw"]]
    assert stiff_robot.ALMemory.getData("ActiveDiagnosisErrorChanged") == [1, ["HeadYaw"]]
    assert stiff_robot.ALMemory.getData("ALDiagnosis/ActiveDiagnosisFinished") == "wakeUp"
    # The chain takes no stiffness, the rest of the robot works.
    stiff_robot.advance(3.0)
    stiff_robot.ALMotion.setStiffnesses("Body", 1.0)
    stiff_robot.advance(SOON)
    assert stiff_robot.ALMotion.getStiffnesses("Head") == [0.0, 0.0]
    assert stiff_robot.ALMemory.getData("ALMotion/Protection/DisabledDevicesChanged") == [["Head", True]]
    assert stiff_robot.ALRobotPosture.getPosture() == "Stand"
    stiff_robot.NaoSimulation.repairDevice("HeadYaw")
    stiff_robot.advance(SOON)
    stiff_robot.ALMotion.setStiffnesses("Head", 1.0)
    assert stiff_robot.ALMotion.getStiffnesses("Head") == [1.0, 1.0]
    assert stiff_robot.ALDiagnosis.getDiagnosisStatus() == [0, []]


def test_a_broken_arm_falls_down(stiff_robot, fail):
    stiff_robot.finish("ALMotion", "angleInterpolation", "LShoulderPitch", 0.0, 1.0, True, after=1.5)
    fail("LShoulderPitch")
    stiff_robot.advance(1.5)
    assert stiff_robot.ALMotion.getAngles("LShoulderPitch", True)[0] > 0.3
    assert stiff_robot.ALMotion.getStiffnesses("LShoulderPitch") == [1.0]


def test_with_a_broken_leg_the_robot_does_not_wake_up_until_it_is_repaired(stiff_robot, fail):
    stiff_robot.finish("ALMotion", "rest", after=3.0)
    fail("LHipRoll")
    stiff_robot.post("ALMotion", "wakeUp")
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(4.0)
    assert stiff_robot.ALDiagnosis.getDiagnosisStatus() == [2, ["LHipRoll"]]
    assert set(stiff_robot.ALMotion.getStiffnesses("Body")) == {0.0}
    with pytest.raises(RuntimeError, match="a motor of the legs is broken, the robot wakes up when it is repaired"):
        stiff_robot.ALMotion.wakeUp()
    stiff_robot.NaoSimulation.repairDevice("LHipRoll")
    stiff_robot.advance(SOON)
    stiff_robot.finish("ALMotion", "wakeUp", after=4.0)
    assert stiff_robot.ALRobotPosture.getPosture() == "Stand"


def test_without_notification_results_are_kept_to_itself(robot, fail):
    robot.advance(SOON)
    before = robot.ALMemory.getData("PassiveDiagnosisErrorChanged")
    robot.ALDiagnosis.setEnableNotification(False)
    assert robot.ALDiagnosis.isNotificationEnabled() is False
    fail("RHand/Touch/Back")
    assert robot.ALMemory.getData("PassiveDiagnosisErrorChanged") == before
    assert robot.ALDiagnosis.getPassiveDiagnosis() == [0, ["RHand/Touch/Back"]]
    robot.ALDiagnosis.setEnableNotification(True)


def test_a_device_that_is_none_is_named(robot):
    with pytest.raises(RuntimeError, match="NaoSimulation::breakDevice unknown device 'LKnee'.*'LKneePitch'"):
        robot.NaoSimulation.breakDevice("LKnee")
    assert {"LKneePitch", "US/Left", "InertialSensor"} <= set(robot.NaoSimulation.devices())
