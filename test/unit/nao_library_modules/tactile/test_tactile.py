"""Goals of NaoTactile: reading, waiting, and what is refused before anything begins."""

from __future__ import annotations

import math

import pytest
from sensor_msgs.msg import BatteryState

from nao_library_msgs.msg import TactileFunction

pytestmark = pytest.mark.usefixtures("clock")


def f(function, **fields):
    return TactileFunction(function=function, **fields)


def test_what_is_touched_is_read(succeed, skin):
    skin.touch(True, "front head", "right bumper")
    result = succeed(f("getTouched"), f("getBumpers"), f("getTouched", sensors=["hands"]))
    assert result.memList == ["front head", "right bumper", "right bumper"]
    assert result.touched == result.memList
    assert [each.values for each in result.results] == [["front head", "right bumper"], ["right bumper"], []]


def test_sonars_are_on_for_a_reading_only_and_silence_is_infinitely_far(succeed, skin, clock):
    skin.set(US_Left=0.75, US_Right=5.0)
    clock.script = [lambda: seen.append(list(skin.sonar.subscribers))]
    seen = []
    result = succeed(f("getSonar"))
    assert [len(subscribers) for subscribers in seen] == [1] and skin.idle()
    assert (result.sonar_names, result.sonar) == (["left", "right"], [0.75, math.inf])


def test_a_sonar_that_failed_is_not_taken_for_silence(succeed, skin, clock):
    skin.set(US_Left=0.0, US_Right=5.0)
    left, right = succeed(f("getSonar")).sonar
    assert math.isnan(left) and right == math.inf


def test_sonars_can_be_left_on_and_are_let_go_at_the_end(succeed, skin, clock, tactile):
    skin.set(US_Left=1.0, US_Right=1.0)
    succeed(f("setSonarEnabled", enable=True), f("getSonar", sensors=["right"]))
    assert len(skin.sonar.subscribers) == 1
    succeed(f("setSonarEnabled", enable=False, revert=True), f("getSonar"))
    assert len(skin.sonar.subscribers) == 1
    tactile.shut_down()
    assert skin.idle()


def test_who_looks_right_after_switching_them_on_gets_what_they_have_measured_since(succeed, skin, clock):
    skin.set(US_Left=0.0, US_Right=0.0)
    clock.script = [lambda: skin.set(US_Left=1.0, US_Right=1.5)]
    assert succeed(f("setSonarEnabled", enable=True), f("getSonar")).sonar == [1.0, 1.5]


def test_weights_of_the_feet_have_names(succeed, skin):
    skin.set(LFoot_FSR_FrontLeft=0.5, LFoot_FSR_FrontRight=0.6, LFoot_FSR_RearLeft=0.7, LFoot_FSR_RearRight=0.8)
    skin.set(LFoot_FSR_TotalWeight=2.6)
    result = succeed(f("getFsr", sensors=["left foot"]))
    corners = [f"left foot {corner}" for corner in ("front left", "front right", "rear left", "rear right")]
    assert result.fsr_names == [*corners, "left foot"]
    assert result.fsr == [0.5, 0.6, 0.7, 0.8, 2.6]


@pytest.mark.parametrize(
    "status, current, supply",
    [
        (0b100000, -1.2, BatteryState.POWER_SUPPLY_STATUS_DISCHARGING),
        (0b10000000, 1.5, BatteryState.POWER_SUPPLY_STATUS_CHARGING),
        (0b1000000, 0.0, BatteryState.POWER_SUPPLY_STATUS_FULL),
        (None, 0.8, BatteryState.POWER_SUPPLY_STATUS_CHARGING),
    ],
)
def test_the_battery_is_a_message(succeed, skin, status, current, supply):
    skin.set(Battery_Charge=0.8, Battery_Current=current)
    skin.memory.data["Device/SubDeviceList/Battery/Charge/Sensor/Status"] = status
    skin.memory.data["Device/SubDeviceList/Battery/Charge/Sensor/TotalVoltage"] = 24600
    result = succeed(f("getBattery"))
    (battery,) = result.battery
    assert (battery.percentage, battery.current, battery.power_supply_status) == (0.8, current, supply)
    assert battery.voltage == pytest.approx(24.6) and result.memList == ["0.8"]


def test_temperatures_of_joints_chains_and_computers(succeed, skin):
    skin.set(HeadYaw_Temperature=31.0, HeadPitch_Temperature=74.0, RHand_Temperature=30.0)
    skin.set(Head_Temperature=58.0, Battery_Temperature=29.0)
    skin.memory.data["Device/SubDeviceList/HeadPitch/Temperature/Sensor/Status"] = 2
    result = succeed(f("getTemperatures"))
    assert result.devices == ["HeadYaw", "HeadPitch", "RHand", "head", "battery"]
    assert result.temperatures == [31.0, 74.0, 30.0, 58.0, 29.0] and result.heat == [0, 2, 0, 0, 0]
    assert succeed(f("getTemperatures", sensors=["Head", "battery"])).devices == ["HeadYaw", "HeadPitch", "battery"]
    assert succeed(f("getTemperatures", sensors=["head"])).devices == ["head"]


def test_waiting_ends_with_the_touch(succeed, skin, clock, tactile):
    clock.script = [lambda: skin.touch(True, "rear head")]
    result = succeed(f("waitForTouch", sensors=["head"], timeout=5.0))
    assert result.touched == ["rear head"] == result.memList and skin.idle()
    assert tactile.server.feedback[-1].status == "waiting" and tactile.server.feedback[-1].touched == ["rear head"]


def test_nothing_in_time_is_an_answer(succeed, skin, clock):
    began = clock.now()
    assert succeed(f("waitForTouch", timeout=3.0)).memList == []
    assert clock.now() - began == pytest.approx(3.0) and skin.idle()


def test_a_hold_is_waited_for_until_it_is_long_enough(succeed, skin, clock):
    clock.script = [lambda: skin.touch(True, "chest"), lambda: None]
    result = succeed(f("waitForTouch", touch="hold", duration=2.0, timeout=10.0))
    assert result.touched == ["chest"]
    assert clock.waits[1] == pytest.approx(2.0)


def test_a_hold_that_is_let_go_is_none(succeed, skin, clock):
    clock.script = [lambda: skin.touch(True, "chest"), lambda: skin.touch(False, "chest")]
    assert succeed(f("waitForTouch", touch="hold", duration=2.0, timeout=4.0)).touched == []


def test_several_presses(succeed, skin, clock):
    press = lambda: (skin.touch(True, "front head"), skin.touch(False, "front head"))  # noqa: E731
    clock.script = [press, press, press]
    assert succeed(f("waitForTouch", touch="count", count=3, timeout=10.0)).touched == ["front head"]


def test_clicks_of_the_chest_button(succeed, skin, clock):
    clock.script = [lambda: skin.raise_event("ALChestButton/DoubleClickOccurred")]
    assert succeed(f("waitForChestButton", count=2)).touched == ["chest"] and skin.idle()
    assert succeed(f("waitForChestButton", timeout=1.0)).touched == []


def test_an_obstacle_comes_near(succeed, skin, clock):
    skin.set(US_Left=1.2, US_Right=0.0)
    clock.script = [lambda: None, lambda: skin.set(US_Left=0.4)]
    result = succeed(f("waitForObstacle", distance=0.5, timeout=5.0))
    assert (result.memList, result.sonar_names, result.sonar) == (["left"], ["left"], [0.4]) and skin.idle()


def test_a_fall(succeed, skin, clock):
    clock.script = [lambda: skin.raise_event("robotHasFallen", True)]
    assert succeed(f("waitForFall")).fell
    assert not succeed(f("waitForFall", timeout=1.0)).fell


def test_a_cancel_ends_the_wait_and_leaves_nothing(tactile, skin, clock):
    from nao_library_actions.msg import NaoTactileGoal

    clock.script = [tactile.server.preempt]
    server = tactile.server.play(NaoTactileGoal([f("waitForTouch", timeout=100.0)]))
    assert server.end == "preempted" and skin.idle()


@pytest.mark.parametrize(
    "function, text",
    [
        (f("waitForTouch", sensors=["nose"]), "nothing that can be touched"),
        (f("waitForTouch", touch="stroke"), "press, release, hold, count"),
        (f("waitForTouch", touch="count", count=21), "0..20"),
        (f("waitForTouch", timeout=-1.0), "0..3600 s"),
        (f("waitForTouch", timeout=math.nan), "0..3600 s"),
        (f("waitForChestButton", count=4), "0..3"),
        (f("waitForObstacle", distance=3.0), "0.1..2.5 m"),
        (f("getSonar", sensors=["rear"]), "left, right"),
        (f("getBumpers", sensors=["chest"]), "chest is no bumper"),
        (f("getFsr", sensors=["left hand"]), "left foot, right foot"),
        (f("getTemperatures", sensors=["Heed"]), "did you mean 'Head'"),
        (f("onTouch"), "the name of a stored behaviour"),
        (f("onTouch", behavior="hello", parameters=["text"]), "name=value"),
        (f("onTouch", behavior="hello", cooldown=-1.0), "0..3600 s"),
        (f("removeOnTouch", str_param="x"), "no link between a touch and a behaviour"),
    ],
)
def test_what_makes_no_sense_is_refused(play, skin, function, text):
    server = play(function)
    assert server.end == "aborted" and text in server.text
    assert skin.idle()
