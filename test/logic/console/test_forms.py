"""What is typed into forms, and commands as they are copied."""

from __future__ import annotations

import math
import shlex
from types import SimpleNamespace

import pytest

from nao_library_modules.behaviors import read
from nao_library_modules.cli.chain_text import build_message, read_chain
from nao_library_modules.console.robots.forms import (
    FormField,
    as_command,
    as_python,
    as_yaml,
    form_of,
    form_of_behavior,
    text_of_value,
    typed_value,
    value_of,
)
from nao_library_modules.core.describe import offline_servers
from nao_library_modules.core.server_types import server_type
from nao_library_msgs.srv import DescribeFunctionsRequest


def command(server, *chain):
    return SimpleNamespace(server=server, chain=tuple(pair for each in chain for pair in each.items()))


@pytest.fixture(scope="module")
def lights():
    server = next(each for each in offline_servers() if each.name == "NaoLights")
    return {each.name: each for each in server.service.answer(DescribeFunctionsRequest()).functions}


def test_a_form_has_what_the_server_declares(lights):
    fields = {field.name: field for field in form_of(lights["fadeRGB"])}
    assert fields["lights"].repeated and fields["lights"].type == "string"
    assert (fields["duration"].low, fields["duration"].unit) == (0.0, "s")
    assert "length of the fade" in fields["duration"].hint
    assert fields["revert"].default is False


@pytest.mark.parametrize(
    "field, text, value",
    [
        (FormField("speed", "float64"), "0.5", 0.5),
        (FormField("angles", "float64", repeated=True), "90deg, 0", [math.pi / 2, 0.0]),
        (FormField("count", "int32"), "3", 3),
        (FormField("lights", "string", repeated=True), "Eyes, Chest", ["Eyes", "Chest"]),
        (FormField("texts", "string", repeated=True), '["a, b", off]', ["a, b", "off"]),
        (FormField("lights", "string", repeated=True), "", []),
        (FormField("revert", "bool"), "true", True),
        (FormField("point", "geometry_msgs/Point"), "{x: 1}", {"x": 1}),
        (FormField("tempo", "number"), "120", 120),
        (FormField("str_param", "string"), " as it is ", " as it is "),
    ],
)
def test_texts_stand_for_values(field, text, value):
    assert value_of(field, text) == value


@pytest.mark.parametrize(
    "field, text, told",
    [
        (FormField("speed", "float64", low=0.1, high=1.0), "2", "2 is not allowed: 0.1..1"),
        (FormField("speed", "float64", unit="m"), "fast", "'fast' is no number: a number in m"),
        (FormField("count", "int32"), "1.5", "no whole number"),
        (FormField("revert", "bool"), "ture", "did you mean 'true'"),
        (FormField("point", "geometry_msgs/Point"), "1", "fields in braces"),
        (FormField("lights", "string", repeated=True), "[a", "no YAML"),
    ],
)
def test_a_wrong_text_is_told_with_what_would_be_right(field, text, told):
    with pytest.raises(ValueError, match=f"^{field.name}: .*{told}"):
        value_of(field, text)


@pytest.mark.parametrize("value", [["a, b"], ["off", "1"], [""], ["Eyes", "Chest"], [], [" a"], ["[x"]])
def test_a_list_that_is_shown_is_read_as_the_same(value):
    field = FormField("texts", "string", repeated=True)
    assert value_of(field, text_of_value(field, value)) == value


@pytest.mark.parametrize(
    "repeated, text, value",
    [
        (False, "${2 / tempo}", "${2 / tempo}"),
        (True, "${all}", "${all}"),
        (True, "LeftEarLed${i}, RightEarLed${i}", ["LeftEarLed${i}", "RightEarLed${i}"]),
        (True, '["${1 - i}", 0.5]', ["${1 - i}", 0.5]),
        (False, "0.5", 0.5),
    ],
)
def test_expressions_of_behaviours_are_left_as_they_are(repeated, text, value):
    assert typed_value(FormField("angle", "float64", repeated=repeated), text) == value


def test_numbers_are_shown_with_all_their_digits():
    field = FormField("angles", "float64", repeated=True)
    assert value_of(field, text_of_value(field, [0.1 + 0.2, 1.0])) == [0.1 + 0.2, 1.0]


FADE = {"fadeRGB": {"lights": ["FaceLeds", "Chest's"], "str_param": "a b, c", "duration": 1.5, "time": 2.0}}
TURN = {"setAngles": {"names": ["HeadYaw"], "angles": ["45deg"], "speed": 0.1}}


def test_the_line_of_a_shell_is_read_as_the_command():
    words = shlex.split(as_command(command("NaoLights", FADE, {"off": {}}), "/nao1/"))
    assert words[:3] == ["nao", "call", "NaoLights"] and words[-2:] == ["--robot", "nao1"]
    first, second = read_chain(words[3:-2])
    message = build_message(first, server_type("NaoLights").function)
    assert (message.lights, message.str_param) == (FADE["fadeRGB"]["lights"], "a b, c")
    assert (message.duration, message.time.to_sec(), second.name) == (1.5, 2.0, "off")


def test_the_program_is_python_with_types_and_the_robot():
    text = as_python(command("NaoLights", FADE), "/nao1/")
    compile(text, "copy.py", "exec")
    assert "SimpleActionClient('/nao1/NaoLights', NaoLedAction)" in text
    assert "from nao_library_msgs.msg import LedFunction" in text
    assert "time=rospy.Duration(2.0)" in text


def test_degrees_are_rad_in_a_program():
    assert "angles=[0.785398]" in as_python(command("NaoMotion", TURN), "/")


def test_a_step_of_yaml_is_read_as_the_command():
    from nao_library_modules.behaviors.strict_yaml import load

    say = {"say": {"str_param": "costs ${5}"}}
    assert load(as_yaml(command("nao_audio_out", say)), "t") == [{"nao_audio_out.say": {"str_param": "costs $${5}"}}]
    chain = load(as_yaml(command("NaoLights", FADE, {"off": {}})), "t")[0]["chain"]["NaoLights"]
    assert [each["function"] for each in chain] == ["fadeRGB", "off"]


def test_parameters_of_a_behaviour_are_fields():
    tempo = "{default: 1.0, help: how fast, min: 0.5, max: 2, unit: times}"
    (field,) = form_of_behavior(read(f"help: h\nparameters:\n  tempo: {tempo}\ndo: [{{wait: 1}}]\n", "mine"))
    assert (field.type, field.low, field.high, field.default) == ("number", 0.5, 2, 1.0)
    assert field.hint == "how fast; 0.5..2; in times"
