"""LED names, groups and lamps."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.leds_layout import load_leds
from nao_sim_bridge.sim.model import VERSIONS


@pytest.mark.parametrize("version", VERSIONS)
def test_counts_of_the_published_tables(version):
    leds = load_leds(version)
    assert (len(leds.devices), len(leds.short_names), len(leds.groups)) == (89, 57, 70)
    assert len(set(leds.devices)) == 89
    assert sorted(leds.devices_of("AllLeds")) == list(range(89))


def test_every_device_belongs_to_exactly_one_lamp():
    leds = load_leds()
    shown = [device for lamp in leds.lamps for device in lamp.devices]
    assert len(leds.lamps) == 51
    assert sorted(shown) == list(range(89))


@pytest.mark.parametrize(
    "name, count",
    [
        ("FaceLeds", 48),
        ("LeftFaceLeds", 24),
        ("RightFaceLedsGreen", 8),
        ("FaceLed3", 6),
        ("EarLeds", 20),
        ("BrainLeds", 12),
        ("FeetLeds", 6),
        ("ChestLedsRed", 1),
        ("Brain0", 1),
        ("ChestBoard/Led/Blue/Actuator/Value", 1),
        ("FaceLedsLeftTop", 9),
        ("RightEarLedsOdd", 5),
    ],
)
def test_groups_expand_to_devices(name, count):
    indices = load_leds().devices_of(name)
    assert len(indices) == len(set(indices)) == count


def test_devices_of_a_color_group_have_that_channel():
    leds = load_leds()
    assert {leds.channels[index] for index in leds.devices_of("AllLedsGreen")} == {"green"}
    assert {leds.channels[index] for index in leds.devices_of("EarLeds")} == {"blue"}
    assert {leds.channels[index] for index in leds.devices_of("BrainLeds")} == {"white"}


def test_unknown_names_offer_the_closest():
    with pytest.raises(UnknownName, match="'LeftFaceLed'.*did you mean 'LeftFaceLeds'"):
        load_leds().devices_of("LeftFaceLed")


def test_guessed_groups_are_named_and_complete():
    leds = load_leds()
    assert "FaceLedsLeftTop" in leds.guessed_groups and "LeftEarLedsEven" in leds.guessed_groups
    assert "FaceLeds" not in leds.guessed_groups
    front, back = leds.devices_of("LeftEarLedsFront"), leds.devices_of("LeftEarLedsBack")
    assert sorted(front + back) == sorted(leds.devices_of("LeftEarLeds"))


def test_left_eye_of_v5_is_numbered_the_other_way():
    device = "Face/Led/Red/Left/45Deg/Actuator/Value"
    v6, v5 = load_leds("V6"), load_leds("V5")
    assert v6.devices == v5.devices
    assert v6.devices[v6.short_names["LeftFaceLed2"][0]] == device
    assert v5.devices[v5.short_names["LeftFaceLed1"][0]] == device


def test_same_index_of_both_eyes_is_at_the_mirrored_place():
    leds = load_leds()
    angle = {lamp.name: lamp.angle for lamp in leds.lamps}
    for index in range(8):
        (left,) = leds.groups[f"FaceLedLeft{index}"]
        (right,) = leds.groups[f"FaceLedRight{index}"]
        assert angle[left] == angle[right] == 45.0 * index


def test_lamps_of_a_part_come_in_order_of_angle():
    ear = load_leds().lamps_of("ear", "Left")
    assert [lamp.name for lamp in ear] == [f"LeftEarLed{n}" for n in range(1, 11)]
    assert ear[0].angle == 18.0


def test_lamp_colors_follow_their_devices():
    leds = load_leds()
    values = [0.0] * 89
    for index, level in zip(leds.short_names["LeftFaceLed1"], (0.2, 0.4, 0.6)):
        values[index] = level
    values[leds.short_names["Brain3"][0]] = 0.5
    by_name = {lamp.name: lamp.rgb(values) for lamp in leds.lamps}
    assert by_name["LeftFaceLed1"] == (0.2, 0.4, 0.6)
    assert by_name["Brain3"] == (0.5, 0.5, 0.5)
    assert by_name["RightFaceLed1"] == (0.0, 0.0, 0.0)
