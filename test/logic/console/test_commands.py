"""Commands of files and forms: read with lines in errors, filled, made into goals."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.core.describe import offline_servers
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.server_types import server_type
from nao_library_modules.studies import commands
from nao_library_modules.studies.commands import FileReader
from nao_library_msgs.srv import DescribeFunctionsRequest
from naoqi.errors import NaoError


def read(text):
    """A command, and what is wrong with it."""
    reader = FileReader(text, "buttons.yaml")
    return commands.read_command(reader, reader.content, "button"), [str(problem) for problem in reader.problems]


@pytest.mark.parametrize(
    "text, server, chain",
    [
        ("say: Hello", "nao_audio_out", [("say", {"str_param": "Hello"})]),
        ("{say: Hello, animated: true}", "nao_audio_out", [("animatedSay", {"str_param": "Hello"})]),
        ("run: hello", "NaoBehavior", [("runBehavior", {"str_param": "hello"})]),
        (
            "{run: hello, with: {color: green, times: 2}}",
            "NaoBehavior",
            [("runBehavior", {"str_param": "hello", "parameters": ["color=green", "times=2"]})],
        ),
        ("{call: NaoLights.off, with: {lights: [FaceLeds]}}", "NaoLights", [("off", {"lights": ["FaceLeds"]})]),
        ("{chain: NaoMotion, steps: [{wakeUp: {}}, rest: {}]}", "NaoMotion", [("wakeUp", {}), ("rest", {})]),
        ("posture: Sit", "NaoMotion", [("goToPosture", {"str_param": "Sit", "speed": 0.8})]),
    ],
)
def test_each_form_is_functions_of_a_server(text, server, chain):
    command, problems = read(text)
    assert not problems and command.server == server and [*command.chain] == chain


def test_a_walk_stands_up_before_and_turns_in_rad_or_degrees():
    command, _ = read("walk_to: [0.5, 0, 90deg]")
    assert [name for name, _ in command.chain] == ["goToPosture", "moveTo"]
    assert command.chain[1][1]["values"] == pytest.approx([0.5, 0.0, math.pi / 2])


def test_a_stop_is_no_goal():
    command, _ = read("stop: true")
    assert command.stops and not command.chain


@pytest.mark.parametrize(
    "text, problem",
    [
        ("label: x", "button (line 1): one of say, run, call,"),
        ("{say: a,\n run: b}", "say and run exclude each other"),
        ("{say: a,\n with: {}}", "button (line 2): with is not for say"),
        ("{say: a,\n animated: 3}", "button.animated (line 2): 3 is neither true nor false"),
        ("call: setColor", "button.call (line 1): SERVER.FUNCTION is wanted"),
        ("call: NaoLights.on\nwith: {light: [FaceLeds]}", "did you mean 'lights'?"),
        ("{chain: NaoMotion, steps:\n [a]}", "button.steps 1 (line 2): FUNCTION: {FIELD: VALUE}"),
        ("walk_to: [1]", "button.walk_to (line 1): m ahead"),
    ],
)
def test_what_will_not_do_is_told_with_its_line(text, problem):
    command, problems = read(text)
    assert len(problems) == 1 and problem in problems[0], problems


def test_templates_are_filled_in_all_texts():
    command = commands.run_behavior("hello", {"text": "Hi {name}, {other}"}).filled({"name": "Kim"})
    assert command.chain[0][1]["parameters"] == ["text=Hi Kim, {other}"]


def test_a_command_comes_back_as_its_file_has_it():
    for text in ("{say: Hello, animated: true}", "{call: NaoLights.off, with: {lights: [FaceLeds]}}"):
        command, _ = read(text)
        assert command.to_yaml() == FileReader(text, "").content
    made = commands.call("NaoLights", "off", lights=["FaceLeds"])
    assert made.to_yaml() == {"call": "NaoLights.off", "with": {"lights": ["FaceLeds"]}}


def test_a_goal_has_the_functions_in_their_order():
    goal = commands.goal_of(commands.walk_to(1.0, 0.0, 0.5), server_type("NaoMotion"))
    assert goal.server == "NaoMotion" and [each.function for each in goal.goal.functions] == ["goToPosture", "moveTo"]
    assert list(goal.goal.functions[1].values) == [1.0, 0.0, 0.5]
    with pytest.raises(BadGoal, match="str_param"):
        commands.goal_of(commands.call("NaoLights", "setColor", str_param=[1]), server_type("NaoLights"))


def describe(server):
    """What the code says of a server."""
    for found in offline_servers():
        if found.name == server:
            return found.service.answer(DescribeFunctionsRequest(["setColor", "off"], False, False))
    raise NaoError(f"there is no server {server}")


@pytest.mark.parametrize(
    "command, problem",
    [
        (commands.call("NaoLights", "setColr"), "NaoLights has no function 'setColr': did you mean 'setColor'?"),
        (commands.call("NaoLights", "setColor", light="x"), "setColor takes no field 'light': did you mean 'lights'?"),
        (commands.call("NaoLights", "off", lights=3), "field off.lights: 3 is not allowed: a list"),
        (commands.call("NaoTeeth", "brush"), "there is no server NaoTeeth"),
    ],
)
def test_a_command_is_checked_against_what_its_server_says(command, problem):
    assert problem in commands.command_problems(command, describe)[0]
    assert commands.command_problems(commands.call("NaoLights", "off", lights=["FaceLeds"]), describe) == []
