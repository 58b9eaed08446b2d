"""One reading of the robot, from what its memory answers."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from nao_library_modules.driver.joint_sensors import JointSensors
from nao_library_modules.driver.motors import torque_per_ampere
from naoqi.errors import NaoError

JOINTS = ("HeadYaw", "RHipYawPitch")
KEY = "Device/SubDeviceList/{}/Value"
TORSO = [0.1, 0.2, 0.33, 0.0, 0.1, 0.5]


@pytest.fixture
def memory():
    values = {
        "HeadYaw/Position/Sensor": 0.5,
        "HeadYaw/Position/Actuator": 0.4,
        "HeadYaw/ElectricCurrent/Sensor": 0.2,
        "LHipYawPitch/Position/Sensor": -0.3,
        "LHipYawPitch/Position/Actuator": -0.25,
        "LHipYawPitch/ElectricCurrent/Sensor": 0.1,
        "InertialSensor/AngleX/Sensor": 0.01,
        "InertialSensor/AngleY/Sensor": 0.02,
    }
    for i, axis in enumerate("XYZ"):
        values[f"InertialSensor/Gyroscope{axis}/Sensor"] = 0.1 * i
        values[f"InertialSensor/Accelerometer{axis}/Sensor"] = 9.81 if axis == "Z" else 0.0
    return {KEY.format(key): value for key, value in values.items()}


@pytest.fixture
def make_sensors(memory, make_call):
    asked = []

    def proxy(_name):
        def call_async(method, *arguments):
            asked.append((method, *arguments))
            call = make_call()
            call.end([memory[key] for key in arguments[0]] if method == "getListData" else TORSO)
            return call

        return SimpleNamespace(call_async=call_async)

    def make(**options):
        return JointSensors(SimpleNamespace(proxy=proxy), JOINTS, **options)

    make.asked = asked
    return make


def test_a_reading_has_joints_inertial_unit_and_torso(make_sensors):
    reading = make_sensors().read()
    assert reading.positions == (0.5, -0.3)
    assert (reading.roll, reading.pitch) == (0.01, 0.02)
    assert reading.angular_velocity == (0.0, 0.1, 0.2)
    assert reading.acceleration == (0.0, 0.0, 9.81)
    assert reading.torso == tuple(TORSO)


def test_efforts_are_torques_towards_the_command(make_sensors):
    efforts = make_sensors().read().efforts
    assert efforts == pytest.approx(
        (-0.2 * torque_per_ampere("HeadYaw"), 0.1 * torque_per_ampere("RHipYawPitch")), abs=1e-9
    )


def test_a_reading_is_one_call_without_odometry_and_two_with_it(make_sensors):
    make_sensors(use_odometry=False).read()
    assert [call[0] for call in make_sensors.asked] == ["getListData"]
    make_sensors.asked.clear()
    make_sensors().read()
    assert make_sensors.asked[1] == ("getPosition", "Torso", 1, True)
    assert len(make_sensors.asked) == 2


def test_commanded_angles_where_there_are_no_sensors(make_sensors):
    assert make_sensors(use_sensors=False).read().positions == (0.4, -0.25)


def test_older_robots_lack_some_values(make_sensors, memory):
    memory[KEY.format("HeadYaw/ElectricCurrent/Sensor")] = None
    memory[KEY.format("InertialSensor/GyroscopeZ/Sensor")] = None
    reading = make_sensors().read()
    assert math.isnan(reading.efforts[0])
    assert reading.angular_velocity[2] == 0.0


@pytest.mark.parametrize("place", [[0.0] * 3, [math.nan] * 6])
def test_a_torso_that_is_nowhere_is_an_error(make_sensors, monkeypatch, place):
    monkeypatch.setitem(globals(), "TORSO", place)
    with pytest.raises(NaoError, match="six numbers are a place"):
        make_sensors().read()


def test_a_joint_without_angle_is_an_error(make_sensors, memory):
    memory[KEY.format("HeadYaw/Position/Sensor")] = None
    with pytest.raises(NaoError, match="None as the angle of HeadYaw"):
        make_sensors().read()


def test_stiffnesses_are_asked_for_apart(make_sensors, memory):
    sensors = make_sensors()
    memory[KEY.format("HeadYaw/Hardness/Actuator")] = 0.6
    memory[KEY.format("LHipYawPitch/Hardness/Actuator")] = None
    head, hip = sensors.read_stiffnesses()
    assert head == 0.6 and math.isnan(hip)
    assert len(make_sensors.asked) == 1
