"""ALLeds over the network: lights at once, lights over time, groups."""

from __future__ import annotations

import pytest

EYE = "LeftFaceLed1"


@pytest.fixture
def leds(robot):
    return robot.ALLeds


def channels(robot, name=EYE):
    """Red, green and blue of an eye segment."""
    return robot.ALLeds.getIntensity(name)


# --- at once ----------------------------------------------------------------------------------------------------------


def test_the_robot_starts_with_white_eyes_and_a_dark_chest(leds):
    assert set(leds.getIntensity("FaceLeds")) == {1.0}
    assert set(leds.getIntensity("ChestLeds")) == {0.0}


@pytest.mark.parametrize("name, count", [("FaceLeds", 48), (EYE, 3), ("EarLeds", 20), ("AllLeds", 89)])
def test_off_and_on_switch_everything_of_the_name(leds, name, count):
    leds.off(name)
    assert leds.getIntensity(name) == [0.0] * count
    leds.on(name)
    assert leds.getIntensity(name) == [1.0] * count


def test_one_led_has_one_intensity(leds):
    leds.setIntensity("Brain0", 0.25)
    assert leds.getIntensity("Brain0") == 0.25
    leds.setIntensity("ChestBoard/Led/Red/Actuator/Value", 0.5)
    assert leds.getIntensity("ChestLedsRed") == 0.5
    assert leds.getIntensity("ChestLedsGreen") == 0.0


def test_reset_brings_back_the_lights_of_the_start(leds):
    leds.off("AllLeds")
    leds.reset("FaceLeds")
    assert set(leds.getIntensity("FaceLeds")) == {1.0}
    assert set(leds.getIntensity("EarLeds")) == {0.0}
    leds.on("ChestLeds")
    leds.reset("AllLeds")
    assert set(leds.getIntensity("EarLeds")) == {1.0}
    assert set(leds.getIntensity("ChestLeds")) == {0.0}


# --- over time --------------------------------------------------------------------------------------------------------


def test_a_fade_passes_through_the_middle_and_answers_at_its_end(robot):
    future = robot.post("ALLeds", "fade", "FaceLeds", 0.0, 2.0)
    robot.handed_over("ALLeds")
    robot.advance(1.0)
    assert robot.ALLeds.getIntensity("FaceLeds") == pytest.approx([0.5] * 48, abs=0.01)
    assert future.isRunning()
    robot.advance(1.01)
    assert robot.answer(future) is None
    assert set(robot.ALLeds.getIntensity("FaceLeds")) == {0.0}


@pytest.mark.parametrize(
    "color, shown",
    [
        ((1.0, 0.5, 0.0), [1.0, 0.5, 0.0]),
        (("green",), [0.0, 1.0, 0.0]),
        (("magenta",), [1.0, 0.0, 1.0]),
        ((0x336699,), [0.2, 0.4, 0.6]),
        ((0,), [0.0, 0.0, 0.0]),
    ],
)
def test_all_three_ways_to_name_a_colour(robot, color, shown):
    robot.finish("ALLeds", "fadeRGB", "FaceLeds", *color, 0.5, after=0.6)
    assert channels(robot) == pytest.approx(shown)


def test_no_duration_changes_the_colour_at_once(robot):
    robot.ALLeds.fadeRGB("FaceLeds", "red", 0.0)
    assert channels(robot) == [1.0, 0.0, 0.0]
    robot.ALLeds.fade(EYE, 0.5, 0.0)
    assert channels(robot) == [0.5] * 3


def test_one_colour_leds_take_the_blue_of_a_colour(robot):
    robot.ALLeds.fadeRGB("AllLeds", 0.1, 0.2, 0.75, 0.0)
    assert robot.ALLeds.getIntensity("LeftEarLed1") == pytest.approx(0.75)
    assert robot.ALLeds.getIntensity("Brain0") == pytest.approx(0.75)


def test_a_list_of_colours_is_met_at_its_times(robot):
    future = robot.post("ALLeds", "fadeListRGB", "FaceLeds", [0xFF0000, 0x0000FF], [1.0, 2.0])
    robot.handed_over("ALLeds")
    robot.advance(1.0)
    assert channels(robot) == pytest.approx([1.0, 0.0, 0.0], abs=0.02)
    robot.advance(0.5)
    assert channels(robot) == pytest.approx([0.5, 0.0, 0.5], abs=0.02)
    robot.advance(0.51)
    robot.answer(future)
    assert channels(robot) == [0.0, 0.0, 1.0]


def test_a_newer_call_takes_over_its_leds(robot):
    old = robot.post("ALLeds", "fade", "FaceLeds", 0.0, 2.0)
    robot.handed_over("ALLeds")
    robot.ALLeds.off(EYE)
    robot.ALLeds.on(EYE)
    robot.advance(2.01)
    robot.answer(old)
    assert channels(robot) == [1.0] * 3
    assert channels(robot, "RightFaceLed1") == [0.0] * 3


def test_cancelling_a_fade_leaves_the_light_there(robot):
    future = robot.post("ALLeds", "fade", "FaceLeds", 0.0, 2.0)
    robot.handed_over("ALLeds")
    robot.advance(1.0)
    future.cancel()
    robot.handed_over("ALLeds")
    robot.advance(1.5)
    assert robot.ALLeds.getIntensity("FaceLeds") == pytest.approx([0.5] * 48, abs=0.01)


def test_random_eyes_twinkle_for_their_time(robot):
    future = robot.post("ALLeds", "randomEyes", 1.0)
    robot.handed_over("ALLeds")
    seen = []
    for _ in range(3):
        robot.advance(0.3)
        seen.append(tuple(robot.ALLeds.getIntensity("FaceLeds")))
    assert len(set(seen)) == 3
    robot.advance(0.2)
    robot.answer(future)
    last = robot.ALLeds.getIntensity("FaceLeds")
    robot.advance(1.0)
    assert robot.ALLeds.getIntensity("FaceLeds") == last


def test_rasta_colours_the_whole_body(robot):
    future = robot.post("ALLeds", "rasta", 1.0)
    robot.handed_over("ALLeds")
    robot.advance(0.1)
    assert channels(robot) == channels(robot, "ChestLeds") == [0.0, 1.0, 0.0]
    robot.advance(0.4)
    assert channels(robot, "LeftFootLeds") == [1.0, 1.0, 0.0]
    robot.advance(0.6)
    assert robot.answer(future) is None


def test_rotating_eyes_light_one_segment_at_a_time(robot):
    future = robot.post("ALLeds", "rotateEyes", 0x00FF00, 0.8, 1.6)
    robot.handed_over("ALLeds")
    lit = []
    for _ in range(8):
        robot.advance(0.1)
        segments = [n for n in range(1, 9) if any(channels(robot, f"LeftFaceLed{n}"))]
        assert len(segments) == 1
        lit += segments
    assert sorted(lit) == list(range(1, 9))
    robot.advance(0.9)
    robot.answer(future)


@pytest.mark.parametrize("stays", [True, False])
def test_ears_show_an_angle(robot, stays):
    future = robot.post("ALLeds", "earLedsSetAngle", 90, 1.0, stays)
    robot.handed_over("ALLeds")
    robot.advance(0.5)
    assert robot.ALLeds.getIntensity("LeftEarLed3") == pytest.approx(1.0)
    assert robot.ALLeds.getIntensity("LeftEarLed8") == 0.0
    robot.advance(0.6)
    robot.answer(future)
    assert robot.ALLeds.getIntensity("RightEarLed3") == pytest.approx(1.0 if stays else 0.0)


# --- refused ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("on", ("FaceLed",), "ALLeds::on unknown LED or group 'FaceLed': did you mean 'FaceLeds'"),
        ("getIntensity", ("Nose",), "unknown LED or group 'Nose'"),
        ("setIntensity", ("FaceLeds", 1.5), "intensity is 1.5, allowed is 0 to 1"),
        ("fade", ("FaceLeds", -0.5, 1.0), "intensity is -0.5, allowed is 0 to 1"),
        ("fade", ("FaceLeds", 0.5, -1.0), "duration is -1.0, allowed is 0 or more"),
        ("fadeRGB", ("FaceLeds", "grein", 1.0), "unknown colour 'grein': did you mean 'green'"),
        ("fadeRGB", ("FaceLeds", 0x1000000, 1.0), "colour is 16777216, allowed is 0x000000 to 0xFFFFFF"),
        ("fadeRGB", ("FaceLeds", 2.0, 0.0, 0.0, 1.0), r"colour\[0\] is 2.0, allowed is 0 to 1"),
        ("fadeListRGB", ("FaceLeds", [1, 2], [1.0]), "rgbList is .* as many colours as times, 1"),
        ("fadeListRGB", ("FaceLeds", [], []), "rgbList is .* at least 1"),
        ("fadeListRGB", ("FaceLeds", [1, 2], [2.0, 1.0]), "timeList is .*, allowed is rising times"),
        ("fadeListRGB", ("FaceLeds", [1.5], [1.0]), "colour is 1.5"),
        ("rotateEyes", (0xFF, 0.0, 1.0), "timeForRotation is 0.0, allowed is above 0"),
        ("randomEyes", (-1.0,), "duration is -1.0, allowed is 0 or more"),
        ("createGroup", ("FaceLeds", [EYE]), "'FaceLeds' is taken by the robot's own LEDs"),
        ("listLED", ("FaceLeds",), "unknown LED 'FaceLeds'"),
        ("listGroup", ("FaceLed",), "unknown group 'FaceLed': did you mean 'FaceLeds'"),
    ],
)
def test_wrong_arguments_name_what_is_allowed_and_change_nothing(shared_robot, method, arguments, message):
    before = shared_robot.ALLeds.getIntensity("AllLeds")
    with pytest.raises(RuntimeError, match=message):
        getattr(shared_robot.ALLeds, method)(*arguments)
    shared_robot.advance(0.05)
    assert shared_robot.ALLeds.getIntensity("AllLeds") == before


# --- names ------------------------------------------------------------------------------------------------------------


def test_a_group_of_ones_own(leds):
    leds.createGroup("MyGroup", [EYE, "Brain0"])
    leds.off("MyGroup")
    assert leds.getIntensity("MyGroup") == [0.0] * 4
    assert leds.listGroup("MyGroup") == [EYE, "Brain0"]
    assert "MyGroup" in leds.listGroups()


def test_lists_of_names(leds):
    assert len(leds.listLEDs()) == 57
    assert "FaceLeds" in leds.listGroups()
    assert [device.split("/")[2] for device in leds.listLED(EYE)] == ["Red", "Green", "Blue"]
