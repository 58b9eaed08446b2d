"""Values of LEDs and the way back to them."""

from __future__ import annotations

import pytest

from nao_library_modules.light_names import LightNames
from nao_library_modules.light_state import (
    light_intensity,
    mean_colour,
    mean_intensity,
    memory_keys,
    restoring_calls,
)

PARTS = ("Red", "Green", "Blue")
NAMES = LightNames.from_listings(
    {
        **{f"Eye{n}": [f"Face/Led/{part}/Left/{n}/Actuator/Value" for part in PARTS] for n in (1, 2)},
        "Brain0": ["Head/Led/0"],
        "Pair": ["Pair/Led/0", "Pair/Led/1"],
    },
    {"Eyes": ["Eye1", "Eye2"], "All": ["Eyes", "Brain0"]},
)


def values(eye1, eye2, brain=0.5):
    eyes = {f"Eye{n}": eye for n, eye in ((1, eye1), (2, eye2))}
    found = {device: part for name, eye in eyes.items() for device, part in zip(NAMES.lights[name], eye)}
    return {**found, "Head/Led/0": brain, "Pair/Led/0": 0.1, "Pair/Led/1": 0.9}


def test_memory_keys():
    assert memory_keys(["Head/Led/0"]) == ["Device/SubDeviceList/Head/Led/0"]


def test_a_coloured_light_is_as_bright_as_its_strongest_led():
    assert light_intensity(NAMES, "Eye1", values((0.1, 0.8, 0.2), (0, 0, 0))) == 0.8


def test_a_group_has_the_mean_of_its_lights():
    state = values((0, 1, 0), (0, 0.5, 0))
    assert mean_intensity(NAMES, "Eyes", state) == 0.75
    assert mean_colour(NAMES, "Eyes", state) == [0, 0.75, 0]


def test_equal_lights_have_their_own_value_as_mean_without_rounding():
    state = values((0.1, 0.2, 0.7), (0.1, 0.2, 0.7))
    assert mean_colour(NAMES, "Eyes", state) == [0.1, 0.2, 0.7]


def test_lights_of_one_colour_have_no_say_in_the_colour_of_a_group():
    assert mean_colour(NAMES, "All", values((1, 0, 0), (1, 0, 0), brain=0.9)) == [1, 0, 0]


def test_restoring_sets_each_light_once_to_its_own_values():
    calls = restoring_calls(NAMES, ["Eyes", "All", "Eye1"], values((0.1, 0.2, 0.3), (0.4, 0.5, 0.6)))
    assert calls == [
        ("fadeRGB", ("Eye1", 0.1, 0.2, 0.3, 0.0)),
        ("fadeRGB", ("Eye2", 0.4, 0.5, 0.6, 0.0)),
        ("setIntensity", ("Brain0", 0.5)),
    ]


def test_a_light_with_several_leds_of_one_colour_is_restored_led_by_led():
    assert restoring_calls(NAMES, ["Pair"], values((0, 0, 0), (0, 0, 0))) == [
        ("setIntensity", ("Pair/Led/0", 0.1)),
        ("setIntensity", ("Pair/Led/1", 0.9)),
    ]


def test_a_single_led_is_restored_under_its_own_name():
    led = NAMES.lights["Eye1"][0]
    state = values((0.25, 0, 0), (0, 0, 0))
    assert restoring_calls(NAMES, [led], state) == [("setIntensity", (led, pytest.approx(0.25)))]
