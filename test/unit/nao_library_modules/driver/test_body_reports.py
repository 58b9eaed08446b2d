"""What the robot says about its body, judged."""

from __future__ import annotations

import pytest

from nao_library_modules.driver import body_reports as reports
from nao_library_modules.driver.body_reports import BATTERY_FLAGS, Thresholds, battery_report, network_reports
from nao_library_modules.health import Level

LIMITS = Thresholds()
JOINTS = ("HeadYaw", "LHipYawPitch", "RHipYawPitch")


def joint(temperature, name="HeadYaw", limits=LIMITS):
    values = {reports.TEMPERATURE.format(name): temperature, reports.STIFFNESS.format(name): 0.6}
    return reports.joint_report(name, values, limits)


@pytest.mark.parametrize(
    "temperature, level, message",
    [
        (38.04, Level.OK, "Normal: 38.0 C"),
        (68.0, Level.WARN, "Hot: 68.0 C"),
        (74.0, Level.ERROR, "Too hot: 74.0 C"),
        (None, Level.OK, "No temperature sensor"),
        (float("nan"), Level.OK, "No temperature sensor"),
    ],
)
def test_joints_get_hot(temperature, level, message):
    report = joint(temperature)
    assert (report.level, report.message) == (level, message)
    assert report.values["Stiffness"] == "0.6"


def test_thresholds_can_be_set():
    assert joint(41.0, limits=Thresholds(warm=40.0, hot=50.0)).level == Level.WARN


def test_every_part_of_the_body_has_a_report():
    keys = reports.keys_of(JOINTS)
    values = {key: 50.0 for key in keys}
    values.update({reports.CHARGE: 0.8, reports.BATTERY_STATUS: 0, reports.AMPERES: -1.2})
    found = reports.body_reports(JOINTS, values, LIMITS)
    assert list(found) == [
        "nao_joint: HeadYaw",
        "nao_joint: LHipYawPitch",
        "nao_joint: RHipYawPitch",
        "nao_power: Battery",
        "nao_power: Current",
        "nao_cpu: Head Temperature",
    ]
    assert found["nao_joint: RHipYawPitch"].message == "No temperature sensor"
    assert found["nao_power: Current"].message == "-1.20 A (discharging)"
    assert [reports.part_of(name) for name in found][2:] == ["RHipYawPitch", "battery", "power", "cpu"]


@pytest.mark.parametrize(
    "charge, bits, level, message",
    [
        (1.0, ["Full Charge Flag"], Level.OK, "Fully charged (100.0 %)"),
        (0.4, ["Charge Flag"], Level.OK, "Charging (40.0 %)"),
        (0.31, [], Level.OK, "OK (31.0 % left)"),
        (0.3, ["Discharging flag"], Level.WARN, "Low (30.0 % left)"),
        (0.1, [], Level.ERROR, "Almost empty (10.0 % left)"),
        (0.9, ["Discharge Temperature Alarm"], Level.ERROR, "Discharge Temperature Alarm (90.0 % left)"),
        (0.9, ["Discharge Over Current Alarm (6A)"], Level.ERROR, "Discharge Over Current Alarm (6A) (90.0 % left)"),
    ],
)
def test_the_battery_runs_down(charge, bits, level, message):
    flags = sum(1 << BATTERY_FLAGS.index(bit) for bit in bits)
    report = battery_report(charge, flags, LIMITS)
    assert (report.level, report.message) == (level, message)
    assert len(report.values) == 18
    assert [name for name in BATTERY_FLAGS if report.values[name] == "True"] == bits


def test_a_robot_that_does_not_tell_is_unknown():
    report = battery_report(None, None, LIMITS)
    assert report.level == Level.WARN and set(report.values.values()) == {"unknown"}
    assert reports.current_report(None).message == "unknown"
    assert reports.head_report(None, LIMITS).level == Level.OK


@pytest.mark.parametrize("temperature, level", [(99.0, Level.OK), (100.0, Level.WARN), (105.0, Level.ERROR)])
def test_the_head_gets_hot(temperature, level):
    assert reports.head_report(temperature, LIMITS).level == level


def test_networks_are_told_by_their_kind():
    services = [
        [["Type", "wifi"], ["Name", "lab"], ["State", "online"], ["Strength", 70]],
        [["Type", "wifi"], ["Name", "other"], ["State", "idle"]],
        "nonsense",
    ]
    found = network_reports(services)
    assert found["nao_wlan: Status"].message == "connected: lab"
    assert found["nao_wlan: Status"].values["Strength"] == "70"
    assert found["nao_ethernet: Status"].message == "not connected"
    assert {report.level for report in network_reports(None).values()} == {Level.OK}
