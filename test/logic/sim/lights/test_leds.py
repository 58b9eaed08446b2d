"""LEDs: names, groups and lamps; named animations."""

from __future__ import annotations

import random

import pytest

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.body import led_animations
from nao_sim_bridge.body.leds import LedBank, LedKeyframe
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.robot_model import VERSIONS

LEDS = load_leds()


@pytest.mark.parametrize("version", VERSIONS)
def test_counts_of_the_published_tables(version):
    leds = load_leds(version)
    assert (len(leds.devices), len(leds.short_names), len(leds.groups), len(leds.lamps)) == (89, 57, 70, 51)
    assert len(set(leds.devices)) == 89
    assert sorted(leds.devices_of("AllLeds")) == list(range(89))
    assert sorted(device for lamp in leds.lamps for device in lamp.devices) == list(range(89)), "each in one lamp"


def test_groups_expand_to_devices():
    counts = {"FaceLeds": 48, "LeftFaceLeds": 24, "RightFaceLedsGreen": 8, "FaceLed3": 6, "EarLeds": 20,
              "BrainLeds": 12, "FeetLeds": 6, "ChestLedsRed": 1, "Brain0": 1, "ChestBoard/Led/Blue/Actuator/Value": 1,
              "FaceLedsLeftTop": 9, "RightEarLedsOdd": 5}  # fmt: skip
    assert {name: len(LEDS.devices_of(name)) for name in counts} == counts
    assert {name: len(set(LEDS.devices_of(name))) for name in counts} == counts
    for name, channel in (("AllLedsGreen", "green"), ("EarLeds", "blue"), ("BrainLeds", "white")):
        assert {LEDS.channels[index] for index in LEDS.devices_of(name)} == {channel}
    assert {"FaceLedsLeftTop", "LeftEarLedsEven"} <= set(LEDS.guessed_groups) and "FaceLeds" not in LEDS.guessed_groups
    front, back = LEDS.devices_of("LeftEarLedsFront"), LEDS.devices_of("LeftEarLedsBack")
    assert sorted(front + back) == sorted(LEDS.devices_of("LeftEarLeds"))
    with pytest.raises(UnknownName, match="'LeftFaceLed'.*did you mean 'LeftFaceLeds'"):
        LEDS.devices_of("LeftFaceLed")


def test_the_left_eye_of_v5_is_numbered_the_other_way():
    v5, device = load_leds("V5"), "Face/Led/Red/Left/45Deg/Actuator/Value"
    assert v5.devices == LEDS.devices
    assert LEDS.devices[LEDS.short_names["LeftFaceLed2"][0]] == device == v5.devices[v5.short_names["LeftFaceLed1"][0]]


def test_lamps_have_angles_and_the_colours_of_their_devices():
    angle = {lamp.name: lamp.angle for lamp in LEDS.lamps}
    for index in range(8):
        (left,), (right,) = LEDS.groups[f"FaceLedLeft{index}"], LEDS.groups[f"FaceLedRight{index}"]
        assert angle[left] == angle[right] == 45.0 * index
    ear = LEDS.lamps_of("ear", "Left")
    assert [lamp.name for lamp in ear] == [f"LeftEarLed{n}" for n in range(1, 11)] and ear[0].angle == 18.0
    values = [0.0] * 89
    for index, level in zip(LEDS.short_names["LeftFaceLed1"], (0.2, 0.4, 0.6)):
        values[index] = level
    values[LEDS.short_names["Brain3"][0]] = 0.5
    shown = {lamp.name: lamp.rgb(values) for lamp in LEDS.lamps}
    assert (shown["LeftFaceLed1"], shown["Brain3"]) == ((0.2, 0.4, 0.6), (0.5, 0.5, 0.5))
    assert shown["RightFaceLed1"] == (0.0, 0.0, 0.0)


def lit(frame, part, side):
    """Names of the lamps of a part that a frame lights."""
    return [lamp.name for lamp in LEDS.lamps_of(part, side) if any(frame.values.get(i) for i in lamp.devices)]


def test_a_number_becomes_a_colour_and_each_device_takes_its_part_of_it():
    assert [led_animations.color_of_int(rgb) for rgb in (0, 0xFF0000)] == [(0, 0, 0), (1, 0, 0)]
    assert led_animations.color_of_int(0x336699) == pytest.approx((0.2, 0.4, 0.6))
    values = led_animations.colored(LEDS, LEDS.devices_of("AllLeds"), (0.1, 0.2, 0.3))
    for channel, share in (("red", 0.1), ("green", 0.2), ("blue", 0.3), ("white", 0.3)):
        assert {values[i] for i in range(89) if LEDS.channels[i] == channel} == {share}


def test_rotating_eyes_light_one_segment_after_the_other_on_both_sides():
    frames = led_animations.rotate_eyes(LEDS, (1.0, 0.0, 0.5), rotation=0.8, duration=1.6)
    assert [frame.time for frame in frames] == pytest.approx([0.1 * k for k in range(17)])
    for side in ("Left", "Right"):
        names = [lamp.name for lamp in LEDS.lamps_of("eye", side)]
        assert [lit(frame, "eye", side) for frame in frames[:-1]] == [[name] for name in names] * 2
    assert [frames[0].values[i] for i in LEDS.lamps_of("eye", "Left")[0].devices] == [1.0, 0.0, 0.5]


@pytest.mark.parametrize("degrees, number", [(18, 1), (90, 3), (198, 6), (270, 8), (-90, 8), (630, 8)])
def test_ears_point_at_an_angle_and_stay_on_only_when_asked(degrees, number):
    for leave_on in (True, False):
        start, end = led_animations.ear_angle(LEDS, degrees, 2.0, leave_on)
        assert (start.time, end.time) == (0.0, 2.0)
        for side in ("Left", "Right"):
            assert lit(start, "ear", side) == [f"{side}EarLed{number}"]
            assert start.values[LEDS.short_names[f"{side}EarLed{number}"][0]] == pytest.approx(1.0)
        assert any(end.values.values()) == leave_on and set(end.values) == set(LEDS.devices_of("EarLeds"))
    between = led_animations.ear_angle(LEDS, 27, 1.0, leave_on=True)[0].values
    shared = [between[LEDS.short_names[f"LeftEarLed{number}"][0]] for number in (1, 2)]
    assert shared == pytest.approx([0.75, 0.25])


def test_random_eyes_change_all_eye_leds_by_chance_for_the_time_asked():
    frames, again, other = (led_animations.random_eyes(LEDS, 1.0, random.Random(seed)) for seed in (3, 3, 4))
    assert frames == again != other
    assert [frame.time for frame in frames] == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    for frame in frames[:-1]:
        assert set(frame.values) == set(LEDS.devices_of("FaceLeds")) and all(
            0.0 <= value <= 1.0 for value in frame.values.values()
        )
    assert frames[0].values != frames[1].values


def test_a_fade_runs_evenly_through_its_colours_and_ends_its_task():
    bank = LedBank(4, TaskIds())
    bank.set({0: 0.2})
    task = bank.animate("fade", [LedKeyframe(2.0, {0: 1.0, 1: 0.5}), LedKeyframe(4.0, {0: 0.0})], now=10.0)
    for now, values in ((10.5, (0.4, 0.125)), (11.75, (0.9, 0.4375)), (12.0, (1.0, 0.5)), (13.0, (0.5, 0.5))):
        bank.tick(now)
        assert bank.values[:2] == pytest.approx(values)
        assert not task.finished
    bank.tick(14.0 - 1e-12)
    assert bank.values[:2] == (0.0, 0.5), "exactly, though its end is a rounding away"
    assert task.finished and not task.killed
