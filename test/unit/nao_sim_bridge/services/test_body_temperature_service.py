"""ALBodyTemperature and its events over the network."""

from __future__ import annotations

import queue

import pytest

SOON = 0.25
EVENTS = (
    "HotDeviceDetected",
    "DeviceNoLongerHotDetected",
    "HotJointDetected",
    "TemperatureStatusChanged",
    "TemperatureDiagnosisErrorChanged",
    "HeadProcessorIsHot",
    "HeadProcessorIsCriticallyHot",
)


@pytest.fixture
def warm(robot):
    def to(**devices):
        for device, celsius in devices.items():
            robot.NaoSimulation.setTemperature(device, celsius)
        robot.advance(SOON)

    robot.advance(SOON)
    return to


@pytest.fixture
def told(robot, listener, warm, patience):
    """What events have told since the last call, by name."""
    for event in EVENTS:
        robot.ALMemory.subscribeToEvent(event, "Listener", "onEvent")

    def since():
        robot.ALMemory.raiseEvent("Test/Last", 0)  # one connection keeps the order
        found = {}
        while True:
            name, value, _ = listener.heard.get(timeout=patience)
            if name == "Test/Last":
                return found
            found[name] = value

    robot.ALMemory.subscribeToEvent("Test/Last", "Listener", "onEvent")
    yield since
    for event in (*EVENTS, "Test/Last"):
        robot.ALMemory.unsubscribeToEvent(event, "Listener")


def test_a_cold_robot_has_nothing_to_tell(robot, warm):
    assert robot.ALBodyTemperature.getTemperatureDiagnosis() == [0, []]
    assert robot.ALMemory.getData("TemperatureStatusChanged") == [0, []]


def test_a_hot_joint_is_told_with_its_severity(robot, warm, told):
    warm(LKneePitch=70.0)
    assert robot.ALBodyTemperature.getTemperatureDiagnosis() == [0, ["LLeg"]]
    assert told() == {
        "HotDeviceDetected": ["LKneePitch"],
        "HotJointDetected": ["LKneePitch"],
        "TemperatureStatusChanged": [1, ["LKneePitch"]],
        "TemperatureDiagnosisErrorChanged": [0, ["LLeg"]],
    }
    warm(HeadYaw=76.0)
    assert robot.ALBodyTemperature.getTemperatureDiagnosis() == [1, ["Head"]]
    warm(HeadYaw=85.0, RShoulderPitch=85.0)
    assert robot.ALBodyTemperature.getTemperatureDiagnosis() == [2, ["Head", "RArm"]]
    assert told()["TemperatureStatusChanged"] == [3, ["HeadYaw", "RShoulderPitch"]]


def test_what_has_cooled_down_is_told(warm, told):
    warm(LElbowRoll=72.0, RElbowRoll=72.0)
    told()
    warm(LElbowRoll=40.0)
    assert told() == {
        "DeviceNoLongerHotDetected": ["LElbowRoll"],
        "TemperatureStatusChanged": [1, ["RElbowRoll"]],
        "TemperatureDiagnosisErrorChanged": [0, ["RArm"]],
    }


def test_head_and_battery_can_be_hot(robot, warm, told):
    warm(Head=100.0)
    found = told()
    assert found["HotDeviceDetected"] == ["Head"]
    assert found["HeadProcessorIsHot"] == pytest.approx(100.0, abs=0.5)
    assert "TemperatureDiagnosisErrorChanged" not in found
    assert robot.ALMemory.getData("Device/SubDeviceList/Head/Temperature/Sensor/Value") == pytest.approx(100.0, abs=0.5)
    warm(Head=108.0, Battery=65.0)
    found = told()
    assert found["HotDeviceDetected"] == ["Head", "Battery"]
    assert found["HeadProcessorIsCriticallyHot"] == pytest.approx(108.0, abs=0.5)


def test_without_notifications_nothing_is_told(robot, warm, told, listener):
    assert robot.ALBodyTemperature.areNotificationsEnabled() is True
    robot.ALBodyTemperature.setEnableNotifications(False)
    assert robot.ALBodyTemperature.areNotificationsEnabled() is False
    warm(HeadPitch=72.0)
    assert told() == {}
    robot.ALBodyTemperature.setEnableNotifications(True)
    robot.advance(SOON)
    assert told()["HotDeviceDetected"] == ["HeadPitch"]
    with pytest.raises(queue.Empty):
        listener.heard.get_nowait()


@pytest.mark.parametrize(
    "device, celsius, message",
    [
        ("Tail", 30.0, "unknown device 'Tail'"),
        ("LKneepitch", 30.0, "did you mean 'LKneePitch'"),
        ("Head", 1000.0, "temperature is 1000.0, allowed is -40 to 200"),
    ],
)
def test_a_temperature_that_cannot_be_is_refused(robot, device, celsius, message):
    with pytest.raises(RuntimeError, match=f"NaoSimulation::setTemperature .*{message}"):
        robot.NaoSimulation.setTemperature(device, celsius)
