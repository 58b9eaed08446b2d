"""The body: judged reports, poses by name, joints of a description, facts of the robot, motors, readings, lights."""

from __future__ import annotations

import json
import math
import random
from types import SimpleNamespace

import pytest

from nao_library_modules.core import health as reports
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.files import config_file
from nao_library_modules.core.health import BATTERY_FLAGS, Level, Thresholds, battery_report, network_reports
from nao_library_modules.core.joint_trajectory import H25_BODY
from nao_library_modules.core.poses import BadPose, Pose, UnknownPose, built_in, library, pose_table
from nao_library_modules.driver.joints.joint_sensors import JointSensors, read_motors, torque_per_ampere
from nao_library_modules.driver.life.nao_leds import Blinks, joined, shown
from nao_library_modules.driver.sensors.nao_diagnostic_updater import KEYS, facts_of, info_fields
from nao_library_modules.driver.sensors.nao_sonar import range_of
from nao_library_modules.driver.sensors.nao_tactile import keys_of, read_foot
from nao_library_msgs.msg import RobotInfo
from naoqi.errors import NaoError

LIMITS = Thresholds()
NAN, INFINITE = math.nan, math.inf


def refused(words, function, *arguments, error=NaoError):
    with pytest.raises(error, match=words):
        function(*arguments)


def test_joints_get_hot():
    for temperature, limits, level, message in (
        (38.04, LIMITS, Level.OK, "Normal: 38.0 C"),
        (68.0, LIMITS, Level.WARN, "Hot: 68.0 C"),
        (74.0, LIMITS, Level.ERROR, "Too hot: 74.0 C"),
        (41.0, Thresholds(warm=40.0, hot=50.0), Level.WARN, "Hot: 41.0 C"),
        (NAN, LIMITS, Level.OK, "No temperature sensor"),
    ):
        values = {reports.TEMPERATURE.format("HeadYaw"): temperature, reports.STIFFNESS.format("HeadYaw"): 0.6}
        report = reports.joint_report("HeadYaw", values, limits)
        assert (report.level, report.message, report.values["Stiffness"]) == (level, message, "0.6")


def test_the_battery_runs_down():
    for charge, bits, level, message in (
        (1.0, ["Full Charge Flag"], Level.OK, "Fully charged (100.0 %)"),
        (0.31, [], Level.OK, "OK (31.0 % left)"),
        (0.3, ["Discharging flag"], Level.WARN, "Low (30.0 % left)"),
        (0.1, [], Level.ERROR, "Almost empty (10.0 % left)"),
        (0.9, ["Discharge Temperature Alarm"], Level.ERROR, "Discharge Temperature Alarm (90.0 % left)"),
    ):
        report = battery_report(charge, sum(1 << BATTERY_FLAGS.index(bit) for bit in bits), LIMITS)
        assert (report.level, report.message, len(report.values)) == (level, message, 18)
        assert [name for name in BATTERY_FLAGS if report.values[name] == "True"] == bits


def test_every_part_of_the_body_has_a_report():
    joints = ("HeadYaw", "LHipYawPitch", "RHipYawPitch")
    values = {key: 50.0 for key in reports.keys_of(joints)}
    values.update({reports.CHARGE: 0.8, reports.BATTERY_STATUS: 0, reports.AMPERES: -1.2})
    found = reports.body_reports(joints, values, LIMITS)
    others = ["nao_power: Battery", "nao_power: Current", "nao_cpu: Head Temperature"]
    assert list(found) == [*(f"nao_joint: {joint}" for joint in joints), *others]
    assert found["nao_joint: RHipYawPitch"].message == "No temperature sensor"
    assert found["nao_power: Current"].message == "-1.20 A (discharging)"
    assert [reports.part_of(name) for name in found][2:] == ["RHipYawPitch", "battery", "power", "cpu"]


def test_all_parts_are_one_report_as_bad_as_the_worst():
    joints = ("HeadYaw", "LHipYawPitch", "LKneePitch")
    values = {key: 40.0 for key in reports.keys_of(joints)}
    values.update({reports.CHARGE: 0.8, reports.BATTERY_STATUS: 0, reports.temperature_key("LKneePitch"): 50.0})
    well = reports.summary(reports.body_reports(joints, values, LIMITS))
    assert (well.level, well.message, well.values["LKneePitch"]) == (Level.OK, "well", "Normal: 50.0 C")
    values.update({reports.CHARGE: 0.2, reports.temperature_key("LKneePitch"): 90.0})
    bad = reports.summary(reports.body_reports(joints, values, LIMITS))
    assert (bad.level, bad.message) == (Level.ERROR, "LKneePitch (Too hot), battery (Low)")
    alarms = ["Discharge Over Current Alarm (14A)", "Discharge Temperature Alarm"]
    values.update({reports.BATTERY_STATUS: sum(1 << BATTERY_FLAGS.index(each) for each in alarms)})
    values.update({reports.HEAD_TEMPERATURE: 101.0, reports.temperature_key("LKneePitch"): 40.0})
    bad = reports.summary(reports.body_reports(joints, values, LIMITS))
    assert bad.message == f"battery ({', '.join(alarms)}), cpu (Hot)"


def test_a_robot_that_does_not_tell_is_unknown_a_head_gets_hot_and_networks_are_told_by_their_kind():
    report = battery_report(None, None, LIMITS)
    assert report.level == Level.WARN and set(report.values.values()) == {"unknown"}
    assert reports.current_report(None).message == "unknown"
    wifi = [["Type", "wifi"], ["Name", "lab"], ["State", "online"], ["Strength", 70]]
    found = network_reports([wifi, [["Type", "wifi"], ["Name", "other"], ["State", "idle"]], "nonsense"])
    wifi = found["nao_wlan: Status"]
    assert (wifi.message, wifi.values["Strength"]) == ("connected: lab", "70")
    assert found["nao_ethernet: Status"].message == "not connected"
    levels = [reports.head_report(temperature, LIMITS).level for temperature in (None, 99.0, 100.0, 105.0)]
    assert levels == [Level.OK, Level.OK, Level.WARN, Level.ERROR]


POSE = {"joint_names": ["Head"], "positions": [0.1, 0.2], "time_from_start": 2}


def test_tables_of_nao_robot_and_libraries_of_choregraphe_hold_poses():
    assert pose_table({"nod": POSE}) == {"nod": Pose(("Head",), (0.1, 0.2), 2.0)}
    one = {"joint_names": "HeadYaw", "positions": 0.5, "time_from_start": 1.0}
    assert pose_table({"look": one}) == {"look": Pose(("HeadYaw",), (0.5,), 1.0)}
    poses = built_in()
    assert set(poses) == {"init", "zero", "crouch"}
    assert all((pose.joints, len(pose.positions)) == (("Body",), len(H25_BODY)) for pose in poses.values())
    assert "did you mean 'init'" in str(UnknownPose("inti", poses))
    arms = library(str(config_file("poses.xap")))["ArmsForward"]
    assert set(arms.joints) <= set(H25_BODY) and arms.time == 2.0
    for change, problem in (
        ({"speed": 1}, "it has joint_names, positions, time_from_start, speed"),
        ({"positions": ["far"]}, "'far' is no number"),
        ({"positions": []}, "0 positions"),
        ({"time_from_start": 0}, "0 s"),
    ):
        refused(problem, pose_table, {"nod": {**POSE, **change}}, error=BadPose)


NAO = {KEYS["body type"]: "Nao", KEYS["head version"]: "6.0.0", KEYS["body version"]: 5.0, KEYS["arm version"]: None}


def test_a_robot_is_known_by_its_facts_and_joints():
    facts = facts_of(NAO)
    assert facts["body version"] == "5.0" and facts["arm version"] == "" and set(facts) == set(KEYS)
    for joints, model, hands in ((26, "nao_h25", 2), (22, "nao_h21", 0)):
        info = RobotInfo(**info_fields(facts, joints))
        assert (info.type, info.model, info.number_of_hands) == (RobotInfo.NAO, model, hands)
        assert (info.number_of_legs, info.number_of_arms, info.has_laser) == (2, 2, False)
    for name in ("Juliette", "Pepper"):
        info = RobotInfo(**info_fields(facts_of({KEYS["body type"]: name, KEYS["laser"]: "1"}), 20))
        assert (info.type, info.has_laser, info.number_of_legs) == (RobotInfo.PEPPER, True, 1)


def test_every_joint_has_a_motor_whose_torque_constant_is_voltage_over_speed(tmp_path):
    assert all(0.2 < torque_per_ampere(joint) < 5.0 for joint in H25_BODY)
    assert torque_per_ampere("LKneePitch") == torque_per_ampere("RKneePitch")
    assert math.isnan(torque_per_ampere("Tail"))
    motor = {"model": "M", "no_load_rpm": 60.0, "gear_ratios": {"Tail": 10.0}}
    table = {"_source": "test", "voltage_v": 2.0 * math.pi, "gear_efficiency": 0.5, "motors": [motor]}
    path = tmp_path / "motors.json"
    path.write_text(json.dumps(table))
    assert read_motors(path) == {"Tail": pytest.approx(5.0)}
    path.write_text(json.dumps({**table, "voltage": 1.0}))
    refused("the fields are", read_motors, path, error=ValueError)


class Answers:
    """A robot whose memory answers what the test says, in the order of the keys: joints, commands, currents, body."""

    def __init__(self, *values, torso=(0.1, 0.2, 0.33, 0.0, 0.1, 0.5)):
        self._values, self._torso = list(values), list(torso)

    def proxy(self, name):
        return self

    def call_async(self, method, *arguments):
        return SimpleNamespace(result=lambda timeout: self._values if method == "getListData" else self._torso)


BODY = (0.01, 0.02, 0.0, 0.1, 0.2, 0.0, 0.0, 9.81)


def test_efforts_are_torques_towards_the_command_and_commands_may_stand_for_sensors():
    answers = Answers(0.5, -0.3, 0.4, -0.25, 0.2, 0.1, *BODY)
    joints = ("HeadYaw", "RHipYawPitch")
    reading = JointSensors(answers, joints).read()
    torques = (-0.2 * torque_per_ampere("HeadYaw"), 0.1 * torque_per_ampere("RHipYawPitch"))
    assert reading.positions == (0.5, -0.3) and reading.efforts == pytest.approx(torques, abs=1e-9)
    assert (reading.roll, reading.pitch, reading.torso) == (0.01, 0.02, (0.1, 0.2, 0.33, 0.0, 0.1, 0.5))
    assert (reading.angular_velocity, reading.acceleration) == ((0.0, 0.1, 0.2), (0.0, 0.0, 9.81))
    reading = JointSensors(answers, joints, use_sensors=False, use_odometry=False).read()
    assert (reading.positions, reading.torso) == ((0.4, -0.25), None)


def test_what_a_robot_lacks_is_no_number_but_an_angle_and_a_place_it_has():
    older = JointSensors(Answers(0.5, 0.4, None, 0.01, 0.02, 0.0, 0.1, None, *BODY[5:]), ["HeadYaw"]).read()
    assert math.isnan(older.efforts[0]) and older.angular_velocity[2] == 0.0
    stiffness = JointSensors(Answers(0.6, None), ["HeadYaw", "HeadPitch"]).read_stiffnesses()
    assert stiffness[0] == 0.6 and math.isnan(stiffness[1])
    refused("None as the angle of HeadYaw", JointSensors(Answers(None, 0.4, 0.2, *BODY), ["HeadYaw"]).read)
    for torso in ([0.0] * 3, [NAN] * 6):
        refused("six numbers are a place", JointSensors(Answers(0.5, 0.4, 0.2, *BODY, torso=torso), ["HeadYaw"]).read)


@pytest.mark.parametrize(
    "value, range_",
    [(0.25, 0.25), (2.54, 2.54), (2.55, INFINITE), (0.1, -INFINITE), (1, 1.0)],
)
def test_distances_follow_rep_117_and_a_sonar_that_failed_has_none(value, range_):
    assert range_of(value) == range_
    assert all(math.isnan(range_of(failed)) for failed in (0.0, -1.0, None, "far", True, NAN))


def test_forces_under_the_feet_are_newtons_and_a_foot_in_the_air_has_no_centre():
    foot = read_foot([0.5, 0.6, 0.7, 0.8, 2.6, 0.01, 0.002, 1.0])
    assert foot.forces == pytest.approx((4.905, 5.886, 6.867, 7.848))
    assert (foot.total, foot.center, foot.contact) == (pytest.approx(25.506), (0.01, 0.002), True)
    foot = read_foot([0.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0])
    assert all(math.isnan(each) for each in foot.center) and foot.total == pytest.approx(0.0981)
    foot = read_foot([None] * 8)
    assert math.isnan(foot.total) and not foot.contact
    assert keys_of("right")[3] == "Device/SubDeviceList/RFoot/FSR/RearRight/Sensor/Value"
    assert keys_of("right")[-1] == "rightFootContact"


RED, BLACK = (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)


RED, BLACK = (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)


def test_pauses_between_blinks_are_cut_at_both_ends_and_what_cannot_be_blinked_is_told():
    chance = random.Random(3)
    pauses = [Blinks([RED], BLACK, 0.3, 1.0, 2.0).pause(chance) for _ in range(2000)]
    assert min(pauses) == 0.0 and 6.9 < max(pauses) <= 7.0 and 1.0 < sum(pauses) / len(pauses) < 1.6
    Blinks([RED], BLACK, 0.3, 1.0, 0.0).check()
    for words, blinks in (
        ("colors", Blinks([], BLACK, 0.3, 1.0, 0.1)),
        (r"colors\[0\]", Blinks([(0.0, 2.0, 0.0)], BLACK, 0.3, 1.0, 0.1)),
        ("bg_color", Blinks([RED], (0.0, 0.0, -1.0), 0.3, 1.0, 0.1)),
        ("blink_duration", Blinks([RED], BLACK, 0.0, 1.0, 0.1)),
        ("blink_rate_mean", Blinks([RED], BLACK, 0.3, 0.0, 0.1)),
        ("blink_rate_sd", Blinks([RED], BLACK, 0.3, 1.0, -0.1)),
    ):
        refused(words, blinks.check, error=BadGoal)


def test_lights_show_their_colours():
    chest, ear, head = "ChestBoard/Led/{}/Actuator/Value", "Ears/Led/Left/0Deg/Actuator/Value", "Head/Led/Front/A/Value"
    parts = {f"ChestLeds{part}": (chest.format(part),) for part in ("Red", "Green", "Blue")}
    lights = joined({**parts, "LeftEarLed1": (ear,), "Brain0": (head,)})
    values = {chest.format("Green"): 0.5, chest.format("Red"): None, ear: 1.0, head: 2.0}
    assert shown(lights, values) == {
        "ChestLeds": (0.0, 0.5, 0.0),
        "LeftEarLed1": (0.0, 0.0, 1.0),
        "Brain0": (1.0, 1.0, 1.0),
    }
