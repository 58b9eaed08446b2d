"""ALLeds: lights at once, lights over time, groups."""

import pytest

EYE = "LeftFaceLed1"


@pytest.fixture
def leds(robot):
    return robot.ALLeds


@pytest.fixture
def shown(robot):
    """Intensities of a name."""
    return lambda name=EYE: robot.ALLeds.getIntensity(name)


def test_lights_at_once_and_those_of_the_start(robot, leds, shown):
    assert set(shown("FaceLeds")) == {1.0} and set(shown("ChestLeds")) == {0.0}
    for name, count in (("FaceLeds", 48), (EYE, 3), ("EarLeds", 20), ("AllLeds", 89)):
        leds.off(name)
        assert shown(name) == [0.0] * count
        leds.on(name)
        assert shown(name) == [1.0] * count
    leds.off("AllLeds")
    leds.setIntensity("Brain0", 0.25)
    assert shown("Brain0") == 0.25 == robot.led("Head/Led/Front/Right/1")
    leds.setIntensity("ChestBoard/Led/Red/Actuator/Value", 0.5)
    assert (shown("ChestLedsRed"), shown("ChestLedsGreen")) == (0.5, 0.0)
    leds.reset("FaceLeds")
    assert set(shown("FaceLeds")) == {1.0} and set(shown("EarLeds")) == {0.0}


def test_colours_in_all_ways_at_once_or_in_time(robot, leds, shown):
    for color, wanted in (
        ((1.0, 0.5, 0.0), [1.0, 0.5, 0.0]),
        (("magenta",), [1.0, 0.0, 1.0]),
        ((0x336699,), [0.2, 0.4, 0.6]),
    ):
        robot.finish("ALLeds", "fadeRGB", "FaceLeds", *color, 0.2, after=0.25)
        assert shown() == pytest.approx(wanted)
    leds.fadeRGB("FaceLeds", "red", 0.0)
    assert shown() == [1.0, 0.0, 0.0]
    leds.fade(EYE, 0.5, 0.0)
    assert shown() == [0.5] * 3
    leds.fadeRGB("AllLeds", 0.1, 0.2, 0.75, 0.0)  # those of one colour take the blue
    assert (shown("LeftEarLed1"), shown("Brain0")) == pytest.approx((0.75, 0.75))


def test_a_newer_call_takes_over_its_leds_and_a_cancelled_one_leaves_the_light_there(robot, begin, leds, shown):
    future = begin("ALLeds", "fade", "FaceLeds", 0.0, 2.0)
    leds.on(EYE)
    robot.advance(1.0)
    future.cancel()
    robot.handed_over("ALLeds")
    robot.advance(1.5)
    assert shown() == [1.0] * 3 and shown("RightFaceLed1") == pytest.approx([0.5] * 3, abs=0.01)


def test_rasta_colours_the_whole_body_and_eyes_rotate_segment_by_segment(robot, begin, shown):
    rasta = begin("ALLeds", "rasta", 1.0, after=0.1)
    assert shown() == shown("ChestLeds") == [0.0, 1.0, 0.0]
    robot.advance(0.4)
    assert shown("LeftFootLeds") == [1.0, 1.0, 0.0]
    robot.advance(0.6)
    assert robot.answer(rasta) is None
    lit, _ = [], begin("ALLeds", "rotateEyes", 0x00FF00, 0.8, 1.6)
    for _ in range(8):
        robot.advance(0.1)
        lit.append([n for n in range(1, 9) if any(shown(f"LeftFaceLed{n}"))])
    assert sorted(lit) == [[n] for n in range(1, 9)]


def test_groups_and_lists_of_names(leds, shown):
    leds.createGroup("MyGroup", [EYE, "Brain0"])
    leds.off("MyGroup")
    assert shown("MyGroup") == [0.0] * 4 and leds.listGroup("MyGroup") == [EYE, "Brain0"]
    assert {"MyGroup", "FaceLeds"} <= set(leds.listGroups()) and len(leds.listLEDs()) == 57
    assert [device.split("/")[2] for device in leds.listLED(EYE)] == ["Red", "Green", "Blue"]


def test_wrong_arguments_name_what_is_allowed(refuses):
    refuses("ALLeds", r"""
        on('FaceLed') -> unknown LED or group 'FaceLed': did you mean 'FaceLeds'
        fade('FaceLeds', 0.5, -1.0) -> duration is -1.0, allowed is 0 or more
        fadeRGB('FaceLeds', 'grein', 1.0) -> unknown colour 'grein': did you mean 'green'
        fadeRGB('FaceLeds', 0x1000000, 1.0) -> colour is 16777216, allowed is 0x000000 to 0xFFFFFF
        fadeListRGB('FaceLeds', [1, 2], [1.0]) -> rgbList is .* as many colours as times, 1
        rotateEyes(0xFF, 0.0, 1.0) -> timeForRotation is 0.0, allowed is above 0
        createGroup('FaceLeds', ['Brain0']) -> 'FaceLeds' is taken by the robot's own LEDs
    """)  # fmt: skip
