"""ALMemory's device keys: all that are documented, with plausible values, and the facts behind them."""

from __future__ import annotations

import re

import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.services import live_keys as module
from nao_sim_bridge.services.live_keys import constants, live_keys
from nao_sim_bridge.sim.config import read_json
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.leds_layout import load_leds
from nao_sim_bridge.sim.model import load_model

TABLES = read_json(config_file(module.FILE))
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


@pytest.fixture(scope="module")
def readings(shared_robot):
    """Every documented key of a robot that stands, read at once."""
    shared_robot.NaoSimulation.reset()
    shared_robot.ALMotion.setStiffnesses("Body", 1.0)
    shared_robot.advance(1.0)
    return dict(zip(DOCUMENTED, shared_robot.ALMemory.getListData(DOCUMENTED)))


@pytest.fixture
def read(robot):
    return lambda key: robot.ALMemory.getData(PREFIX + key)


def test_there_are_303_documented_keys():
    assert len(DOCUMENTED) == len(set(DOCUMENTED)) == TABLES["_meta"]["count_documented_keys"] == 303


@pytest.mark.parametrize("pattern, low, high", PLAUSIBLE, ids=[pattern for pattern, _, _ in PLAUSIBLE])
def test_documented_keys_answer_with_plausible_numbers(readings, pattern, low, high):
    keys = [key for key in DOCUMENTED if pattern == next(p for p, _, _ in PLAUSIBLE if re.fullmatch(p, key))]
    assert keys, "the pattern fits no key"
    for key in keys:
        value = readings[key]
        assert type(value) is (int if key.endswith("/Status") else float), key
        assert low - 1e-6 <= value <= high + 1e-6, key


def test_all_of_them_are_listed(shared_robot):
    assert set(DOCUMENTED) <= set(shared_robot.ALMemory.getDataListName())


@pytest.mark.parametrize("version", ["V6", "V5"])
def test_every_led_has_its_key(version):
    leds = load_leds(version)
    keys = live_keys(None, load_model(version), leds, lambda: tuple(range(len(leds.devices))))
    for index, device in enumerate(leds.devices):
        assert keys[PREFIX + device]() == index


def test_a_key_that_nothing_can_read_is_an_error(monkeypatch):
    tables = {**TABLES, "devices": {"smell": {"keys": ["Nose/Smell/Sensor/Value"]}}}
    monkeypatch.setattr(module, "read_json", lambda path: tables)
    with pytest.raises(ConfigError, match="nothing in the simulation can read 'Nose/Smell/Sensor/Value'"):
        live_keys(None, load_model(), load_leds(), tuple)


# --- the facts behind the keys ----------------------------------------------------------------------------------------


def test_the_feet_weigh_the_robot_in_kg(readings):
    total = sum(readings[f"{PREFIX}{side}Foot/FSR/TotalWeight/Sensor/Value"] for side in "LR")
    assert total == pytest.approx(5.36, rel=0.01)
    for side in "LR":
        corners = [readings[f"{PREFIX}{side}Foot/FSR/{c}/Sensor/Value"] for c in module.CORNERS]
        assert sum(corners) == pytest.approx(readings[f"{PREFIX}{side}Foot/FSR/TotalWeight/Sensor/Value"], rel=1e-3)


def test_foot_contact_follows_the_load(stiff_robot):
    def contacts():
        return [stiff_robot.ALMemory.getData(f"{foot}ontact") for foot in ("footC", "leftFootC", "rightFootC")]

    stiff_robot.advance(0.5)
    assert contacts() == [1.0, 1.0, 1.0]
    total = sum(stiff_robot.ALMemory.getData(f"{side}FootTotalWeight") for side in ("left", "right"))
    assert total == pytest.approx(5.36, rel=0.01)
    stiff_robot.NaoSimulation.push([0.0, 0.0, 60.0], 0.3, "torso")
    stiff_robot.advance(0.3)
    assert contacts() == [0.0, 0.0, 0.0]


def test_joints_tell_command_sensor_and_stiffness(stiff_robot, read):
    stiff_robot.finish("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 0.5, True, after=1.0)
    assert read("HeadYaw/Position/Actuator/Value") == pytest.approx(0.5)
    assert read("HeadYaw/Position/Sensor/Value") == pytest.approx(0.5, abs=0.01)
    stiff_robot.ALMotion.setStiffnesses("HeadYaw", 0.25)
    stiff_robot.advance(0.01)
    assert read("HeadYaw/Hardness/Actuator/Value") == 0.25


def test_an_arm_held_out_draws_current_and_warms_up(stiff_robot, read):
    stiff_robot.advance(0.5)
    idle = read("LShoulderPitch/ElectricCurrent/Sensor/Value")
    stiff_robot.finish("ALMotion", "angleInterpolation", "LShoulderPitch", 0.0, 1.0, True, after=2.0)
    assert read("LShoulderPitch/ElectricCurrent/Sensor/Value") > idle + 0.05
    warm = read("LShoulderPitch/Temperature/Sensor/Value")
    stiff_robot.advance(2.0)
    assert read("LShoulderPitch/Temperature/Sensor/Value") > warm > read("HeadYaw/Temperature/Sensor/Value")


@pytest.mark.parametrize(
    "warmth, status", [(27.0, 0), (67.9, 0), (68.0, 1), (73.9, 1), (74.0, 2), (79.9, 2), (80.0, 3), (120.0, 3)]
)
def test_the_status_of_a_motor_follows_its_warmth(warmth, status):
    class Runner:
        class snapshot:  # noqa: N801  stands for an object
            temperatures = (warmth,) * 26

    keys = live_keys(Runner, load_model(), load_leds(), tuple)
    assert keys[f"{PREFIX}HeadYaw/Temperature/Sensor/Status"]() == status


@pytest.mark.parametrize("device", ["Head/Touch/Front", "LHand/Touch/Back", "RFoot/Bumper/Left", "ChestBoard/Button"])
def test_a_pressed_sensor_reads_one(robot, read, device):
    robot.NaoSimulation.press([device])
    robot.advance(0.01)
    assert read(f"{device}/Sensor/Value") == 1.0
    robot.NaoSimulation.press([])
    robot.advance(0.01)
    assert read(f"{device}/Sensor/Value") == 0.0


def test_the_gyroscope_and_the_angles_notice_a_fall(stiff_robot, read):
    stiff_robot.NaoSimulation.push([60.0, 0.0, 0.0], 0.2, "torso")
    stiff_robot.advance(0.3)
    assert read("InertialSensor/GyroscopeY/Sensor/Value") > 0.5
    assert read("InertialSensor/GyrY/Sensor/Value") == read("InertialSensor/GyroscopeY/Sensor/Value")
    stiff_robot.advance(1.5)
    assert read("InertialSensor/AngleY/Sensor/Value") > 1.0


def test_led_keys_follow_alleds(robot, read):
    robot.ALLeds.fadeRGB("ChestLeds", 0.25, 0.5, 0.75, 0.0)
    assert [read(f"ChestBoard/Led/{c}/Actuator/Value") for c in ("Red", "Green", "Blue")] == [0.25, 0.5, 0.75]


def test_a_full_battery_has_its_full_capacity(robot, read):
    assert read("Battery/Charge/Sensor/RemainingCapacity") == read("Battery/Charge/Sensor/FullChargeCapacity") == 2900
    assert read("Battery/Charge/Sensor/Status") == (1 << 3) | (1 << 5) | (1 << 6)  # may be discharged, and is; full


def test_the_robot_tells_its_version(robot):
    assert robot.ALMemory.getData("RobotConfig/Body/Version") == "6.0.0"
    assert robot.ALMemory.getData("RobotConfig/Head/FullHeadId") == "SIMULATED-NAO-HEAD"
    v5 = constants("V5")
    assert (v5["RobotConfig/Body/Version"], v5["RobotConfig/Head/Type"]) == ("5.0.0", "Nao")
    assert set(constants("V6")) <= set(v5)
