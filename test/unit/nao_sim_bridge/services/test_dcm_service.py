"""The DCM over the network: timed commands really move joints, stiffen them and light LEDs."""

from __future__ import annotations

import pytest

PREFIX = "Device/SubDeviceList/"
HEAD, HEAD_PITCH = "HeadYaw/Position/Actuator/Value", "HeadPitch/Position/Actuator/Value"
RED, BLUE = "ChestBoard/Led/Red/Actuator/Value", "ChestBoard/Led/Blue/Actuator/Value"


@pytest.fixture
def read(robot):
    return lambda key: robot.ALMemory.getData(key if key.startswith(PREFIX) else PREFIX + key)


@pytest.fixture
def send(robot):
    """Sends a command when it has been taken."""

    def call(method, *arguments):
        robot.answer(robot.post("DCM", method, *arguments))

    return call


def test_its_time_is_simulated_time(robot):
    before = robot.DCM.getTime(0)
    assert robot.DCM.getTime(500) == before + 500
    robot.advance(0.25)
    assert robot.DCM.getTime(0) == before + 250
    assert robot.DCM.getPrefix() == PREFIX


def test_a_joint_goes_in_straight_lines_through_timed_values(stiff_robot, read, send):
    time = stiff_robot.DCM.getTime
    send("set", [PREFIX + HEAD, "ClearAll", [[0.5, time(1000)], [-0.1, time(2000)]]])
    stiff_robot.advance(0.5)
    assert read("HeadYaw/Position/Actuator/Value") == pytest.approx(0.25, abs=0.01)
    stiff_robot.advance(0.5)
    assert read("HeadYaw/Position/Sensor/Value") == pytest.approx(0.5, abs=0.03)
    stiff_robot.advance(1.2)
    assert read("HeadYaw/Position/Sensor/Value") == pytest.approx(-0.1, abs=0.02)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", False) == [pytest.approx(-0.1)]


def test_clear_all_stops_what_was_to_come_and_merge_keeps_it(stiff_robot, read, send):
    time = stiff_robot.DCM.getTime
    send("set", [HEAD, "ClearAll", [[0.6, time(2000)]]])
    send("set", [HEAD, "Merge", [[0.2, time(1000)]]])
    stiff_robot.advance(1.0)
    assert read(HEAD) == pytest.approx(0.2, abs=0.01)
    stiff_robot.advance(0.5)
    assert read(HEAD) == pytest.approx(0.4, abs=0.01)
    send("set", [HEAD, "ClearAll", [[0.4, time(0)]]])
    stiff_robot.advance(1.0)
    assert read(HEAD) == pytest.approx(0.4, abs=0.01)


def test_stiffness(robot, read, send):
    send("set", ["LKneePitch/Hardness/Actuator/Value", "Merge", [[0.8, robot.DCM.getTime(400)]]])
    robot.advance(0.2)
    assert read("LKneePitch/Hardness/Actuator/Value") == pytest.approx(0.4, abs=0.03)
    robot.advance(0.3)
    assert robot.ALMotion.getStiffnesses("LKneePitch") == [pytest.approx(0.8)]


def test_leds_fade_to_their_moment(robot, read, send):
    robot.ALLeds.off("ChestLeds")
    send("set", [RED, "Merge", [[1.0, robot.DCM.getTime(1000)]]])
    robot.advance(0.5)
    assert read(RED) == pytest.approx(0.5, abs=0.02)
    robot.advance(0.6)
    assert (read(RED), read(BLUE)) == (1.0, 0.0)


def test_an_alias_commands_several(stiff_robot, read, send):
    assert stiff_robot.DCM.createAlias(["Chest", [RED, PREFIX + BLUE]]) == ["Chest", [RED, BLUE]]
    send("set", ["Chest", "ClearAll", [[0.25, stiff_robot.DCM.getTime(0)]]])
    stiff_robot.advance(0.1)
    assert (read(RED), read(BLUE)) == (0.25, 0.25)
    stiff_robot.DCM.createAlias(["Look", [HEAD, HEAD_PITCH]])
    time = stiff_robot.DCM.getTime(500)
    send("setAlias", ["Look", "ClearAll", "time-separate", 0, [time, time + 500], [[0.3, 0.4], [0.1, 0.2]]])
    stiff_robot.advance(0.5)
    assert (read(HEAD), read(HEAD_PITCH)) == (pytest.approx(0.3, abs=0.01), pytest.approx(0.1, abs=0.01))
    stiff_robot.advance(0.6)
    assert (read(HEAD), read(HEAD_PITCH)) == (pytest.approx(0.4), pytest.approx(0.2))
    time = stiff_robot.DCM.getTime(400)
    send("setAlias", ["Look", "Merge", "time-mixed", [[[0.0, time]], [[0.0, time + 400]]]])
    stiff_robot.advance(0.45)
    assert read(HEAD) == pytest.approx(0.0) and read(HEAD_PITCH) == pytest.approx(0.1, abs=0.02)
    stiff_robot.advance(0.45)
    send("setAlias", "Look", stiff_robot.DCM.getTime(300), [0.2, 0.05])
    stiff_robot.advance(0.4)
    assert (read(HEAD), read(HEAD_PITCH)) == (pytest.approx(0.2), pytest.approx(0.05))


def test_it_takes_joints_from_almotion(stiff_robot, send, read):
    task = stiff_robot.post("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 3.0, True)
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(0.5)
    send("set", [HEAD, "ClearAll", [[-0.2, stiff_robot.DCM.getTime(500)]]])
    stiff_robot.answer(task)
    stiff_robot.advance(0.6)
    assert read(HEAD) == pytest.approx(-0.2)


def test_legs_that_walk_are_left_alone(stiff_robot, send):
    stiff_robot.advance(0.2)
    stiff_robot.post("ALMotion", "moveToward", 0.5, 0.0, 0.0)
    stiff_robot.handed_over("ALMotion")
    stiff_robot.advance(0.5)
    with pytest.raises(RuntimeError, match="DCM::set the robot walks, and LKneePitch with it: stop it first"):
        send("set", ["LKneePitch/Position/Actuator/Value", "ClearAll", [[1.0, stiff_robot.DCM.getTime(500)]]])


def test_preferences_are_keys_of_the_memory_that_can_be_brought_back(robot):
    def value():
        return robot.ALMemory.getData("Test/Preference")

    assert robot.DCM.preferences("Save", "Chest", "Test/Preference", 3.5) == 0
    assert value() == 3.5
    assert robot.DCM.preferences("Add", "Chest", "Test/Preference", 4.5) == 0
    assert value() == 4.5
    assert robot.DCM.preferences("Load", "Chest", "Test/Preference", 0) == 0
    assert value() == 3.5
    with pytest.raises(RuntimeError, match="one that was saved for 'Head'"):
        robot.DCM.preferences("Load", "Head", "Test/Preference", 0)
    assert robot.DCM.preferences("Remove", "Chest", "Test/Preference", 0) == 0
    with pytest.raises(RuntimeError, match="keyName is '', allowed is the name of a key of ALMemory"):
        robot.DCM.preferences("Save", "Chest", "", 1.0)
    with pytest.raises(RuntimeError, match="is a sensor of the robot and cannot be written"):
        robot.DCM.preferences("Save", "Chest", "Device/SubDeviceList/HeadYaw/Position/Sensor/Value", 1.0)
    with pytest.raises(RuntimeError, match="keyName is 'Test/Preference', allowed is one that was saved"):
        robot.DCM.preferences("Load", "Chest", "Test/Preference", 0)
    with pytest.raises(RuntimeError, match="action is 'Erase', allowed is Save, Add, Load, Remove"):
        robot.DCM.preferences("Erase", "Chest", "Test/Preference", 0)


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("set", (["HeadJaw/Position/Actuator/Value", "Merge", [[0.0, 0]]],), "unknown actuator 'HeadJaw.*did you mean"),
        ("set", ([HEAD, "Sometimes", [[0.0, 0]]],), "update type is 'Sometimes', allowed is Merge"),
        ("set", ([HEAD, "Merge"],), r"commands is .*, allowed is \[device or alias"),
        ("set", ([HEAD, "Merge", [[float("nan"), 0]]],), r"commands\[2\]\[0\]\[0\] is nan, allowed is a finite number"),
        ("set", ([HEAD, "Merge", [0.5]],), r"commands\[2\]\[0\] is 0.5, allowed is \[value, moment in ms\]"),
        ("createAlias", (["Nobody", []],), "alias is .*, allowed is .*at least one device"),
        ("setAlias", ("Unheard", 0, [0.5]), "alias is 'Unheard', allowed is"),
        ("setAlias", (["Unheard", "Merge", "time-odd", [[]]],), "commands is .*time-mixed.*time-separate"),
        ("calibration", ([],), "exact: there is nothing to calibrate"),
        ("special", ("Chest Reset",), "has no boards"),
    ],
)
def test_wrong_commands_name_what_is_right(robot, send, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"DCM::{method} .*{message}"):
        send(method, *arguments)
