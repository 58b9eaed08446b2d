"""What fields of light functions may hold, names of lights, their values and the way back to them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.lights_and_colours import (
    LightNames,
    UnknownLight,
    colour_part,
    from_integer,
    named_colours,
    parse_colour,
    read_colours,
    to_integer,
)
from nao_library_modules.lights import light_fields as light_goals
from nao_library_modules.lights.led_access import light_intensity, mean_colour, mean_intensity, memory_keys

ROOT = Path(__file__).resolve().parents[3]
TWO = ["LeftFaceLeds", "RightFaceLeds"]
RED, *_ = EYE = [f"Face/Led/{part}/Left/0Deg/Actuator/Value" for part in ("Red", "Green", "Blue")]
BRAIN = "Head/Led/Front/Right/0/Actuator/Value"
NAN = float("nan")


def refused(text, function, *arguments):
    with pytest.raises(BadGoal, match=text):
        function(*arguments)


def test_colours_are_in_one_field_only():
    refused("field i_values: there is a colour in str_param already", light_goals.colours, TWO, [0, 1, 0], "green")


def test_colours_as_text_and_as_integers(tmp_path):
    for text, colour in (
        ("green", (0, 1, 0)), (" Yellow ", (1, 1, 0)), ("off", (0, 0, 0)), ("#FF0000", (1, 0, 0)),
        ("0x0000ff", (0, 0, 1)), ("#336699", (0.2, 0.4, 0.6)),
    ):  # fmt: skip
        assert parse_colour(text) == pytest.approx(colour)
    for text in ("#FFF", "0xGG0000", "", "FF0000", "#FF0000 #00FF00"):
        refused("'#RRGGBB', '0xRRGGBB' or one of white, red", parse_colour, text)
    refused("unknown colour 'grean': did you mean 'green'", parse_colour, "grean")
    assert to_integer(from_integer(0x123456)) == 0x123456
    documented = (ROOT / "docs/functions.md").read_text(encoding="utf-8")
    assert [name for name in named_colours() if f"`{name}`" not in documented] == []
    assert set("white red green blue yellow magenta cyan".split()) <= set(named_colours())
    (tmp_path / "colours.json").write_text(json.dumps({"odd": [0, 0, 2]}))
    with pytest.raises(ValueError, match="odd"):
        read_colours(tmp_path / "colours.json")


def test_groups_lights_and_leds_are_used_alike():
    names = LightNames.from_listings(
        {"Eye": EYE, "Brain0": [BRAIN]},
        {"Eyes": ["Eye"], "Head": ["Eyes", "Brain0", "Eye"], "Reds": [RED], "Loop": ["Loop", "Brain0"]},
    )
    assert (names.groups["Head"], names.groups["Loop"]) == (("Eye", "Brain0"), ("Brain0",)), "each light once"
    assert names.expand(["Brain0", "Eyes", BRAIN]) == ["Brain0", "Eye", BRAIN] and names.expand(["Reds"]) == [RED]
    assert names.devices(["Eyes", "Reds", "Brain0"]) == [*EYE, BRAIN]
    assert [names.is_coloured(name) for name in ("Eye", "Head", "Brain0", "Reds", RED)] == [True, True] + [False] * 3
    with pytest.raises(UnknownLight, match="unknown light 'Brain': did you mean 'Brain0'"):
        names.expand(["Brain"])
    assert names.with_group("Mine", ["Eyes", "Brain0"]).groups["Mine"] == ("Eye", "Brain0")
    assert not names.knows("Mine"), "a new group is a new dictionary"
    assert [colour_part(device) for device in (*EYE, BRAIN)] == ["Red", "Green", "Blue", ""]


def test_plain_words_mean_the_robots_groups_and_its_own_names_come_before():
    listed = {"Eye": EYE, "Brain0": [BRAIN]}
    names = LightNames.from_listings(listed, {"FaceLeds": ["Eye"], "EarLeds": ["Brain0"]})
    assert names.expand(["Eyes", "Ears", "FaceLeds"]) == ["Eye", "Brain0"]
    assert names.is_coloured("Eyes") and not names.is_coloured("Ears")
    assert [names.of_robot(name) for name in ("Eyes", "Ears", "Eye", "Chest")] == [
        "FaceLeds",
        "EarLeds",
        "Eye",
        "Chest",
    ]
    assert not names.knows("Chest"), "this robot has no such group"
    with pytest.raises(UnknownLight, match="unknown light 'eyes': did you mean 'Eyes'"):
        names.expand(["eyes"])
    own = names.with_group("Eyes", ["Brain0"])
    assert own.expand(["Eyes"]) == ["Brain0"] and own.of_robot("Eyes") == "Eyes"


# Values

NAMES = LightNames.from_listings(
    {
        **{f"Eye{n}": [device.replace("0Deg", f"{n}") for device in EYE] for n in (1, 2)},
        "Brain0": ["Head/Led/0"],
        "Pair": ["Pair/Led/0", "Pair/Led/1"],
    },
    {"Eyes": ["Eye1", "Eye2"], "All": ["Eyes", "Brain0"]},
)


def values(eye1, eye2, brain=0.5):
    eyes = {"Eye1": eye1, "Eye2": eye2}
    found = {device: part for name, eye in eyes.items() for device, part in zip(NAMES.lights[name], eye)}
    return {**found, "Head/Led/0": brain, "Pair/Led/0": 0.1, "Pair/Led/1": 0.9}


def test_lights_are_as_bright_as_their_strongest_led_and_groups_as_their_mean():
    assert memory_keys(["Head/Led/0"]) == ["Device/SubDeviceList/Head/Led/0"]
    assert light_intensity(NAMES, "Eye1", values((0.1, 0.8, 0.2), (0, 0, 0))) == 0.8
    state = values((0, 1, 0), (0, 0.5, 0))
    assert (mean_intensity(NAMES, "Eyes", state), mean_colour(NAMES, "Eyes", state)) == (0.75, [0, 0.75, 0])
    equal = values((0.1, 0.2, 0.7), (0.1, 0.2, 0.7))
    assert mean_colour(NAMES, "Eyes", equal) == [0.1, 0.2, 0.7], "without rounding"
    assert mean_colour(NAMES, "All", values((1, 0, 0), (1, 0, 0), brain=0.9)) == [1, 0, 0]
