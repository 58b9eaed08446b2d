"""Parameters described in Python are what the tools of dynamic_reconfigure understand."""

from __future__ import annotations

import pytest
from dynamic_reconfigure.encoding import decode_description, encode_description

from nao_library_modules.driver.reconfigure import Field, description_of

FIELDS = (
    Field("volume", -1, "how loud", -1, 100),
    Field("voice", "", "who speaks"),
    Field("beep", True, "whether it beeps"),
    Field("speed", 1.5, "how fast"),
    Field("frequency", 16000, "samples a second", 16000, 48000, {16000: "one channel", 48000: "four channels"}),
)


@pytest.fixture
def parameters():
    """The description after its way to a client and back."""
    group = decode_description(encode_description(description_of(FIELDS)))
    return {each["name"]: each for each in group["parameters"]}


def test_names_types_and_defaults_arrive(parameters):
    assert {name: (each["type"], each["default"]) for name, each in parameters.items()} == {
        "volume": ("int", -1),
        "voice": ("str", ""),
        "beep": ("bool", True),
        "speed": ("double", 1.5),
        "frequency": ("int", 16000),
    }
    assert parameters["volume"]["description"] == "how loud"


def test_limits_arrive_and_open_ones_are_wide(parameters):
    assert (parameters["volume"]["min"], parameters["volume"]["max"]) == (-1, 100)
    assert parameters["speed"]["min"] == float("-inf")
    assert (parameters["beep"]["min"], parameters["beep"]["max"]) == (False, True)


def test_choices_are_what_a_tool_evaluates(parameters):
    enum = eval(parameters["frequency"]["edit_method"])["enum"]  # as the tools do
    assert [(entry["value"], entry["description"]) for entry in enum] == [
        (16000, "one channel"),
        (48000, "four channels"),
    ]
    assert parameters["volume"]["edit_method"] == ""


def test_each_parameter_has_a_level_of_its_own(parameters):
    assert len({each["level"] for each in parameters.values()}) == len(FIELDS)
