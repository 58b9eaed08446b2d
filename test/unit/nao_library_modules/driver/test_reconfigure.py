"""Parameters described in Python are what the tools of dynamic_reconfigure understand."""

from __future__ import annotations

import pytest
from dynamic_reconfigure.encoding import decode_description, encode_description

from nao_library_modules.driver import reconfigure
from nao_library_modules.driver.reconfigure import Field, description_of
from naoqi.errors import NaoError

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


@pytest.mark.parametrize(
    "name, value, allowed",
    [
        ("volume", 101, "~volume is 101: a whole number from -1 to 100"),
        ("volume", -2, "~volume is -2: a whole number from -1 to 100"),
        ("volume", 50.0, "~volume is 50.0: a whole number from -1 to 100"),
        ("volume", True, "~volume is True: a whole number from -1 to 100"),
        ("voice", 3, "~voice is 3: a text"),
        ("beep", "yes", "~beep is 'yes': true or false"),
        ("speed", "fast", "~speed is 'fast': a number"),
        ("frequency", 22050, r"~frequency is 22050: 16000 \(one channel\) or 48000 \(four channels\)"),
    ],
)
def test_what_a_parameter_cannot_be_is_told_when_the_node_begins(monkeypatch, name, value, allowed):
    monkeypatch.setattr(reconfigure, "Server", lambda *_: pytest.fail("the server takes it"))
    monkeypatch.setattr(reconfigure.rospy, "get_param", lambda key, default: value if key == f"~{name}" else default)
    with pytest.raises(NaoError, match=allowed):
        reconfigure.serve(FIELDS, lambda before, after: after)


class Server:
    """That of dynamic_reconfigure, as far as it calls back."""

    def __init__(self, description, callback):
        self._config = dict(description.defaults)
        self._callback = callback
        self.update_configuration({})

    def update_configuration(self, changes):
        self._config = self._callback({**self._config, **changes}, 0)


def test_what_is_refused_is_the_error_that_it_was(monkeypatch):
    refused = NaoError("not so loud")
    seen = []

    def changed(before, after):
        if after["volume"] > 50:
            raise refused
        seen.append((before.get("volume"), after["volume"]))
        return after

    monkeypatch.setattr(reconfigure, "Server", Server)
    monkeypatch.setattr(reconfigure.rospy, "get_param", lambda key, default: default)
    server = reconfigure.serve(FIELDS, changed)
    with pytest.raises(NaoError) as caught:
        reconfigure.update(server, {"volume": 80})
    assert caught.value is refused
    reconfigure.update(server, {"volume": 20})
    assert seen == [(None, -1), (-1, 20)]
