"""Key frames of the named LED animations."""

from __future__ import annotations

import random

import pytest

from nao_sim_bridge.sim import led_animations
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.leds_layout import load_leds

LEDS = load_leds()
EYES = set(LEDS.devices_of("FaceLeds"))


def lit(frame, part, side):
    """Names of the lamps of a part that a frame lights."""
    return [lamp.name for lamp in LEDS.lamps_of(part, side) if any(frame.values.get(i) for i in lamp.devices)]


@pytest.mark.parametrize(
    "rgb, color", [(0x000000, (0, 0, 0)), (0xFF0000, (1, 0, 0)), (0x00FF00, (0, 1, 0)), (0x336699, (0.2, 0.4, 0.6))]
)
def test_a_number_becomes_a_color(rgb, color):
    assert led_animations.color_of_int(rgb) == pytest.approx(color)


def test_each_device_takes_its_part_of_a_color():
    values = led_animations.colored(LEDS, LEDS.devices_of("AllLeds"), (0.1, 0.2, 0.3))
    for channel, share in (("red", 0.1), ("green", 0.2), ("blue", 0.3), ("white", 0.3)):
        assert {values[i] for i in range(89) if LEDS.channels[i] == channel} == {share}


def test_after_boot_eyes_ears_and_head_shine_white_and_the_rest_is_dark():
    values = led_animations.power_on(LEDS)
    assert sorted(values) == list(range(89))
    shining = {i for name in ("FaceLeds", "EarLeds", "BrainLeds") for i in LEDS.devices_of(name)}
    assert {i for i, value in values.items() if value == 1.0} == shining
    assert all(values[i] == 0.0 for i in LEDS.devices_of("ChestLeds") + LEDS.devices_of("FeetLeds"))


def test_random_eyes_change_all_eye_leds_and_nothing_else_for_the_time_asked():
    frames = led_animations.random_eyes(LEDS, 1.0, random.Random(3))
    assert [frame.time for frame in frames] == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    for frame in frames[:-1]:
        assert set(frame.values) == EYES
        assert all(0.0 <= value <= 1.0 for value in frame.values.values())
    assert frames[0].values != frames[1].values


def test_chance_is_the_only_difference_between_two_random_eyes():
    first, again, other = (led_animations.random_eyes(LEDS, 1.0, random.Random(seed)) for seed in (3, 3, 4))
    assert first == again != other


def test_rasta_shows_green_yellow_red_in_turn_on_every_coloured_led():
    frames = led_animations.rasta(LEDS, 1.6)
    assert [frame.time for frame in frames] == pytest.approx([0.0, 0.4, 0.8, 1.2, 1.6])
    chest = [LEDS.short_names[f"ChestLeds{color}"][0] for color in ("Red", "Green", "Blue")]
    shown = [tuple(frame.values[i] for i in chest) for frame in frames[:-1]]
    assert shown == [(0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0)]
    coloured = EYES | {i for name in ("ChestLeds", "FeetLeds") for i in LEDS.devices_of(name)}
    assert set(frames[0].values) == coloured


def test_rotating_eyes_light_one_segment_after_the_other_on_both_sides():
    frames = led_animations.rotate_eyes(LEDS, (1.0, 0.0, 0.5), rotation=0.8, duration=1.6)
    assert [frame.time for frame in frames] == pytest.approx([0.1 * k for k in range(17)])
    for side in ("Left", "Right"):
        order = [lit(frame, "eye", side) for frame in frames[:-1]]
        names = [lamp.name for lamp in LEDS.lamps_of("eye", side)]
        assert order == [[name] for name in names] * 2
    red, green, blue = LEDS.lamps_of("eye", "Left")[0].devices
    assert [frames[0].values[i] for i in (red, green, blue)] == [1.0, 0.0, 0.5]


@pytest.mark.parametrize(
    "animation",
    [
        lambda: led_animations.random_eyes(LEDS, 1e300, random.Random(1)),
        lambda: led_animations.rasta(LEDS, 1e6),
        lambda: led_animations.rotate_eyes(LEDS, (1.0, 0.0, 0.0), 1e-6, 1.0),
    ],
)
def test_an_animation_of_too_many_colours_is_refused(animation):
    with pytest.raises(BadValue, match="duration is .*, allowed is .* s at most"):
        animation()


@pytest.mark.parametrize("degrees, number", [(18, 1), (90, 3), (198, 6), (270, 8), (-90, 8), (630, 8)])
def test_ears_point_with_one_led_at_an_angle_of_its_own(degrees, number):
    frames = led_animations.ear_angle(LEDS, degrees, 1.0, leave_on=False)
    for side in ("Left", "Right"):
        assert lit(frames[0], "ear", side) == [f"{side}EarLed{number}"]
        assert frames[0].values[LEDS.short_names[f"{side}EarLed{number}"][0]] == pytest.approx(1.0)


def test_two_leds_share_the_light_for_an_angle_between_them():
    values = led_animations.ear_angle(LEDS, 27, 1.0, leave_on=True)[0].values
    first, second = (values[LEDS.short_names[f"LeftEarLed{number}"][0]] for number in (1, 2))
    assert (first, second) == pytest.approx((0.75, 0.25))


@pytest.mark.parametrize("leave_on", [True, False])
def test_ears_stay_on_only_when_asked(leave_on):
    start, end = led_animations.ear_angle(LEDS, 90, 2.0, leave_on)
    assert (start.time, end.time) == (0.0, 2.0)
    assert any(end.values.values()) == leave_on
    assert set(end.values) == set(LEDS.devices_of("EarLeds"))
