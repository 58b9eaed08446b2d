"""Groups, lights and LEDs."""

from __future__ import annotations

import pytest

from nao_library_modules.light_names import LightNames, UnknownLight, colour_part

RED, GREEN, BLUE = (f"Face/Led/{part}/Left/0Deg/Actuator/Value" for part in ("Red", "Green", "Blue"))
BRAIN = "Head/Led/Front/Right/0/Actuator/Value"


@pytest.fixture
def names():
    return LightNames.from_listings(
        {"Eye": [RED, GREEN, BLUE], "Brain0": [BRAIN]},
        {"Eyes": ["Eye"], "Head": ["Eyes", "Brain0", "Eye"], "Reds": [RED], "Loop": ["Loop", "Brain0"]},
    )


def test_groups_in_groups_are_resolved_to_lights_each_once(names):
    assert names.groups["Head"] == ("Eye", "Brain0")


def test_a_group_in_itself_does_no_harm(names):
    assert names.groups["Loop"] == ("Brain0",)


def test_lights_groups_and_leds_are_used_alike(names):
    assert names.expand(["Brain0", "Eyes", BRAIN]) == ["Brain0", "Eye", BRAIN]
    assert names.devices(["Eyes", "Reds", "Brain0"]) == [RED, GREEN, BLUE, BRAIN]


def test_a_group_of_leds_has_leds_as_lights(names):
    assert names.expand(["Reds"]) == [RED]


@pytest.mark.parametrize(
    "name, coloured", [("Eye", True), ("Head", True), ("Brain0", False), ("Reds", False), (RED, False)]
)
def test_only_red_green_and_blue_together_make_a_coloured_light(names, name, coloured):
    assert names.is_coloured(name) is coloured


def test_an_unknown_light_comes_with_the_closest_names(names):
    with pytest.raises(UnknownLight, match="unknown light 'Brain': did you mean 'Brain0'"):
        names.expand(["Brain"])
    with pytest.raises(UnknownLight, match="listLEDs and listGroups tell the names"):
        names.expand(["zzzzzz"])


def test_a_new_group_is_a_new_dictionary(names):
    more = names.with_group("Mine", ["Eyes", "Brain0"])
    assert more.groups["Mine"] == ("Eye", "Brain0")
    assert not names.knows("Mine")


def test_colour_parts():
    assert [colour_part(device) for device in (RED, GREEN, BLUE, BRAIN)] == ["Red", "Green", "Blue", ""]
