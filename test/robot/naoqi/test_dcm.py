"""The DCM: timed commands really move joints, stiffen them and light LEDs."""

import pytest

PREFIX = "Device/SubDeviceList/"
HEAD, HEAD_PITCH = "HeadYaw/Position/Actuator/Value", "HeadPitch/Position/Actuator/Value"
RED, BLUE = "ChestBoard/Led/Red/Actuator/Value", "ChestBoard/Led/Blue/Actuator/Value"


@pytest.fixture
def dcm(stiff_robot):
    return stiff_robot.DCM


@pytest.fixture
def send(robot, read):
    """Sends a command when it has been taken, lets time pass, and reads two keys of the head or the chest."""

    def call(method, *arguments, after=0.0, keys=(HEAD, HEAD_PITCH)):
        robot.answer(robot.post("DCM", method, *arguments))
        robot.advance(after)
        return [read(key) for key in keys]

    return call


def near(*values):
    return pytest.approx(list(values), abs=0.02)


def test_a_joint_goes_in_straight_lines_through_timed_values(robot, dcm, send, read):
    send("set", [PREFIX + HEAD, "ClearAll", [[0.5, dcm.getTime(1000)], [-0.1, dcm.getTime(2000)]]], after=0.5)
    assert read(HEAD) == pytest.approx(0.25, abs=0.01)
    robot.advance(0.5)
    assert read("HeadYaw/Position/Sensor/Value") == pytest.approx(0.5, abs=0.03)
    robot.advance(1.2)
    assert read("HeadYaw/Position/Sensor/Value") == pytest.approx(-0.1, abs=0.02)
    send("set", [HEAD, "ClearAll", [[0.6, dcm.getTime(2000)]]])
    assert send("set", [HEAD, "Merge", [[0.2, dcm.getTime(1000)]]], after=1.0, keys=(HEAD,)) == near(0.2)
    assert send("set", [HEAD, "ClearAll", [[0.4, dcm.getTime(0)]]], after=1.0, keys=(HEAD,)) == near(0.4)


def test_stiffness_and_leds_change_until_their_moment(robot, dcm, send, read):
    robot.ALLeds.off("ChestLeds")
    robot.ALMotion.setStiffnesses("LKneePitch", 0.0)
    send("set", ["LKneePitch/Hardness/Actuator/Value", "Merge", [[0.8, dcm.getTime(400)]]])
    assert send("set", [RED, "Merge", [[1.0, dcm.getTime(400)]]], after=0.2, keys=(RED, BLUE)) == near(0.5, 0.0)
    assert read("LKneePitch/Hardness/Actuator/Value") == pytest.approx(0.4, abs=0.03)
    robot.advance(0.3)
    assert robot.ALMotion.getStiffnesses("LKneePitch") == [pytest.approx(0.8)]
    assert (read(RED), read(BLUE)) == (1.0, 0.0)


def test_an_alias_commands_several(robot, dcm, send, read):
    assert dcm.createAlias(["Chest", [RED, PREFIX + BLUE]]) == ["Chest", [RED, BLUE]]
    chest = send("set", ["Chest", "ClearAll", [[0.25, dcm.getTime(0)]]], after=0.1, keys=(RED, BLUE))
    assert chest == [0.25, 0.25]
    dcm.createAlias(["Look", [HEAD, HEAD_PITCH]])
    time = dcm.getTime(500)
    separate = ["Look", "ClearAll", "time-separate", 0, [time, time + 500], [[0.3, 0.4], [0.1, 0.2]]]
    assert send("setAlias", separate, after=0.5) == near(0.3, 0.1)
    robot.advance(0.6)
    assert [read(HEAD), read(HEAD_PITCH)] == near(0.4, 0.2)
    robot.advance(0.45)
    assert send("setAlias", "Look", dcm.getTime(300), [0.2, 0.05], after=0.4) == near(0.2, 0.05)


def test_it_takes_joints_from_almotion_but_not_legs_that_walk(stiff_robot, dcm, begin, send):
    task = begin("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 3.0, True, after=0.5)
    assert send("set", [HEAD, "ClearAll", [[-0.2, dcm.getTime(500)]]], after=0.6, keys=(HEAD,)) == near(-0.2)
    stiff_robot.answer(task)
    begin("ALMotion", "moveToward", 0.5, 0.0, 0.0, after=0.5)
    with pytest.raises(RuntimeError, match="DCM::set the robot walks, and LKneePitch with it: stop it first"):
        send("set", ["LKneePitch/Position/Actuator/Value", "ClearAll", [[1.0, dcm.getTime(500)]]])


def test_wrong_commands_name_what_is_right(refuses):
    refuses("DCM", r"""
        set(['HeadJaw/Position/Actuator/Value', 'Merge', [[0.0, 0]]]) -> unknown actuator 'HeadJaw.*did you mean
        set(['HeadYaw/Position/Actuator/Value', 'Sometimes', [[0.0, 0]]]) -> update type is 'Sometimes', allowed
        set(['HeadYaw/Position/Actuator/Value', 'Merge', [[float('nan'), 0]]]) -> commands\[2\]\[0\]\[0\] is nan
        createAlias(['Nobody', []]) -> alias is .*, allowed is .*at least one device
        setAlias(['Unheard', 'Merge', 'time-odd', [[]]]) -> commands is .*time-mixed.*time-separate
        preferences('Erase', 'Chest', 'Test/Preference', 0) -> action is 'Erase', allowed is Save, Add, Load, Remove
        calibration([]) -> exact: there is nothing to calibrate
    """)  # fmt: skip
