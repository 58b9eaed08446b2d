"""Keys of the devices and what is behind them: all that are documented, and the events about ground and pushes."""

import re

import pytest
from simulator import PATIENCE

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.naoqi.memory import live_keys

TABLES = read_json(config_file(live_keys.FILE))
PREFIX = TABLES["_meta"]["prefix"]
DOCUMENTED = [
    *(f"{PREFIX}{joint}/{suffix}" for joint in TABLES["joints"]["names"] for suffix in TABLES["joints"]["suffixes"]),
    *(PREFIX + key for group in TABLES["devices"].values() for key in group["keys"]),
]
# What a stiff robot that stands on an empty floor reads: the first pattern that fits decides.
PLAUSIBLE = (
    (r".*/Position/(Actuator|Sensor)/Value", -2.1, 2.2),
    (r".*/ElectricCurrent/.*", 0.0, 3.0),
    (r".*/Temperature/Sensor/Status", 0, 0),
    (r".*/Temperature/Sensor/Value", 20.0, 60.0),
    (r".*/Hardness/.*", 1.0, 1.0),
    (r".*/FSR/TotalWeight/.*", 2.0, 3.4),
    (r".*/FSR/CenterOfPressure/.*", -0.08, 0.1),
    (r".*/FSR/.*", 0.0, 3.0),
    (r".*/Gyroscope[XYZ]/.*", -0.01, 0.01),
    (r".*/AccelerometerZ/.*", 9.7, 9.9),
    (r".*/Accelerometer.*", -0.2, 0.2),
    (r".*/Angle[XYZ]/.*", -0.02, 0.02),
    (r".*/US/.*", 0.0, 0.0),  # nobody is subscribed to ALSonar
    (r".*/(Bumper|Touch|Button)/.*", 0.0, 0.0),
    (r".*/Battery/Charge/Sensor/Value", 0.98, 1.0),
    (r".*/Battery/Current/.*", -4.0, -0.3),
    (r".*/Led/.*", 0.0, 1.0),
)


def test_every_documented_key_answers_with_a_plausible_number(stiff_robot):
    stiff_robot.advance(1.0)
    values = dict(zip(DOCUMENTED, stiff_robot.ALMemory.getListData(DOCUMENTED)))
    assert len(values) == TABLES["_meta"]["count_documented_keys"] == 303
    assert set(DOCUMENTED) <= set(stiff_robot.ALMemory.getDataListName())
    fitting = {key: next(row for row in PLAUSIBLE if re.fullmatch(row[0], key)) for key in values}
    assert set(fitting.values()) == set(PLAUSIBLE)
    for key, (_, low, high) in fitting.items():
        assert type(values[key]) is (int if key.endswith("/Status") else float), key
        assert low - 1e-6 <= values[key] <= high + 1e-6, key
    weights = [values[f"{PREFIX}{side}Foot/FSR/TotalWeight/Sensor/Value"] for side in "LR"]
    assert sum(weights) == pytest.approx(5.36, rel=0.01)  # kg
    for side, weight in zip("LR", weights):
        corners = [values[f"{PREFIX}{side}Foot/FSR/{corner}/Sensor/Value"] for corner in live_keys.CORNERS]
        assert sum(corners) == pytest.approx(weight, rel=1e-3)


def test_joints_tell_command_sensor_stiffness_current_and_warmth(stiff_robot, read):
    idle = read("LShoulderPitch/ElectricCurrent/Sensor/Value")
    stiff_robot.post("ALMotion", "angleInterpolation", "LShoulderPitch", 0.0, 0.5, True)
    stiff_robot.finish("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 0.5, True, after=1.5)
    assert read("HeadYaw/Position/Actuator/Value") == pytest.approx(0.5)
    assert read("HeadYaw/Position/Sensor/Value") == pytest.approx(0.5, abs=0.01)
    stiff_robot.ALMotion.setStiffnesses("HeadYaw", 0.25)
    stiff_robot.advance(0.01)
    assert read("HeadYaw/Hardness/Actuator/Value") == 0.25
    assert read("LShoulderPitch/ElectricCurrent/Sensor/Value") > idle + 0.05
    warm = read("LShoulderPitch/Temperature/Sensor/Value")
    stiff_robot.advance(2.0)
    assert read("LShoulderPitch/Temperature/Sensor/Value") > warm > read("HeadYaw/Temperature/Sensor/Value")


def test_the_inertial_unit_notices_a_fall(stiff_robot, read):
    stiff_robot.NaoSimulation.push([60.0, 0.0, 0.0], 0.2, "torso")
    stiff_robot.advance(0.3)
    assert read("InertialSensor/GyroscopeY/Sensor/Value") == read("InertialSensor/GyrY/Sensor/Value") > 0.5
    stiff_robot.advance(1.5)
    assert read("InertialSensor/AngleY/Sensor/Value") > 1.0


def test_sensors_lights_battery_and_version(robot, read):
    for device in ("Head/Touch/Front", "LHand/Touch/Back", "RFoot/Bumper/Left", "ChestBoard/Button"):
        for pressed in (True, False):
            robot.NaoSimulation.press([device] if pressed else [])
            robot.advance(0.01)
            assert read(f"{device}/Sensor/Value") == float(pressed)
    robot.ALLeds.fadeRGB("ChestLeds", 0.25, 0.5, 0.75, 0.0)
    assert [read(f"ChestBoard/Led/{c}/Actuator/Value") for c in ("Red", "Green", "Blue")] == [0.25, 0.5, 0.75]
    charge = f"{PREFIX}Battery/Charge/Sensor/"
    assert read(f"{charge}RemainingCapacity") == read(f"{charge}FullChargeCapacity") == 2900
    assert read(f"{charge}Status") == (1 << 3) | (1 << 5) | (1 << 6)  # may be discharged, and is; full
    assert (read("RobotConfig/Body/Version"), read("RobotConfig/Head/FullHeadId")) == ("6.0.0", "SIMULATED-NAO-HEAD")


def test_ground_under_the_feet_is_told_when_it_is_lost_and_when_it_is_won(stiff_robot, read):
    def contacts():
        return [read(f"{foot}ontact") for foot in ("footC", "leftFootC", "rightFootC")]

    def raised():
        return len(stiff_robot.ALMemory.getEventHistory("footContactChanged"))

    stiff_robot.advance(0.5)
    assert contacts() == [1.0, 1.0, 1.0] and read("footContactChanged") is True
    assert read("leftFootTotalWeight") + read("rightFootTotalWeight") == pytest.approx(5.36, rel=0.01)
    before = raised()
    stiff_robot.ALMotion.move(0.05, 0.0, 0.0)
    steps = set()
    for _ in range(40):
        stiff_robot.advance(0.1)
        steps.add(tuple(contacts()))
    assert stiff_robot.ALMotion.moveIsActive() and raised() == before  # walking keeps contact
    assert {(1.0, 1.0, 0.0), (1.0, 0.0, 1.0)} <= steps <= {(1.0, 1.0, 0.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0)}
    stiff_robot.ALMotion.killMove()
    stiff_robot.NaoSimulation.push([0.0, 0.0, 60.0], 0.5, "torso")
    stiff_robot.advance(0.45)
    assert contacts() == [0.0, 0.0, 0.0] and read("footContactChanged") is False and raised() == before + 1


def test_a_push_from_the_right_is_told_with_its_direction_and_energy(stiff_robot, listener):
    for event in ("ALMotion/RobotPushed", "ALMotion/Safety/RobotPushed", "ALMotion/Safety/PushRecovery", "Test/Last"):
        stiff_robot.ALMemory.subscribeToEvent(event, "Listener", "onEvent")
    stiff_robot.advance(1.5)
    stiff_robot.NaoSimulation.push([0.0, 14.0, 0.0], 0.1, "torso")
    stiff_robot.advance(1.0)
    stiff_robot.ALMemory.raiseEvent("Test/Last", 0)
    told = listener.until("Test/Last")
    angle, energy = told["ALMotion/RobotPushed"]
    assert angle == pytest.approx(1.57, abs=0.4) and 0.003 < energy < 1.0
    assert told["ALMotion/Safety/RobotPushed"] == told["ALMotion/Safety/PushRecovery"] == [angle]


def test_the_level_of_stiffness_is_told_when_it_changes(robot):
    heard = robot.heard("BodyStiffnessChanged")
    for stiffness in (0.5, 1.0, 1.0):
        robot.ALMotion.setStiffnesses("Body", stiffness)
        robot.advance(0.1)
    assert [heard.get(timeout=PATIENCE) for _ in range(2)] == [1, 2]
    assert [value for value, *_ in robot.ALMemory.getEventHistory("BodyStiffnessChanged")] == [1, 2]
    assert robot.ALSensors.getEventList() == ["BodyStiffnessChanged"]
    assert robot.ALMemory.getExtractorEvent("ALFsr") == ["footContactChanged"]
