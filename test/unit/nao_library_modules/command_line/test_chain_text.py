"""Chains as they are typed."""

import click
import pytest

from nao_library_modules.command_line.chain_text import build_message, read_chain, read_value
from nao_library_msgs.msg import LedFunction, MotionFunction


def test_a_function_has_fields():
    (function,) = read_chain(["setColor", "lights:=FaceLeds,EarLeds", "str_param:=a:=b"])
    assert (function.name, function.fields) == ("setColor", {"lights": "FaceLeds,EarLeds", "str_param": "a:=b"})


@pytest.mark.parametrize(
    "words",
    [["on", "a:=1", ",", "off"], ["on", "a:=1", "--then", "off"], ["on,", "off"]],
)
def test_functions_have_a_comma_or_then_between_them(words):
    assert [function.name for function in read_chain(words)][-1] == "off"
    assert len(read_chain(words)) == 2


@pytest.mark.parametrize(
    "words, complaint",
    [
        ([], "function 1 has no name"),
        (["on", ","], "function 2 has no name"),
        (["lights:=a"], "function 1 has no name"),
        (["on", "lights"], "'lights' is no field:=value"),
        (["on", "lights:=a", "lights:=b"], "lights is there twice"),
    ],
)
def test_what_is_no_chain_is_told(words, complaint):
    with pytest.raises(click.UsageError, match=complaint):
        read_chain(words)


@pytest.mark.parametrize(
    "kind, text, value",
    [
        ("string", "5", "5"),
        ("string", "a, b", "a, b"),
        ("string[]", "a, b", ["a", "b"]),
        ("string[]", "[a, 'b, c']", ["a", "b, c"]),
        ("string[]", "", []),
        ("float64", "-1.5e-3", -0.0015),
        ("float64[]", "0,1,.5", [0.0, 1.0, 0.5]),
        ("float64[]", "[0, 1]", [0.0, 1.0]),
        ("int32", "-7", -7),
        ("bool", "yes", True),
        ("bool", "False", False),
    ],
)
def test_values_are_read_by_their_type(kind, text, value):
    assert read_value(kind, text) == value


@pytest.mark.parametrize(
    "kind, text, complaint",
    [
        ("float64", "one", "'one' is no number"),
        ("int32", "1.5", "'1.5' is no whole number"),
        ("int32[]", "[1.5]", "1.5 is no whole number"),
        ("int32[]", "[.inf]", "inf is no whole number"),
        ("duration", "inf", "'inf' is no time"),
        ("duration", "nan", "'nan' is no time"),
        ("duration", "1e300", "'1e300' is no time"),
        ("bool", "perhaps", "neither true nor false"),
        ("float64[]", "1,,2", "'' is no number"),
        ("string[]", "[a", "is no YAML"),
        ("trajectory_msgs/JointTrajectory", "5", "is no trajectory_msgs/JointTrajectory"),
        ("trajectory_msgs/JointTrajectory", "{joint_name: [a]}", "joint_name"),
    ],
)
def test_values_of_another_type_are_refused(kind, text, complaint):
    with pytest.raises(ValueError, match=complaint):
        read_value(kind, text)


def test_times_and_messages_inside_are_read():
    (function,) = read_chain(
        ["setTrajectory", "time:=1.5", "trajectory:={joint_names: [HeadYaw], points: [{positions: [0.1]}]}"]
    )
    message = build_message(function, MotionFunction)
    assert message.time.to_sec() == 1.5
    assert message.trajectory.joint_names == ["HeadYaw"]
    assert message.trajectory.points[0].positions == [0.1]


@pytest.mark.parametrize(
    "field, complaint", [("light:=a", "no field 'light': did you mean 'lights'"), ("function:=on", "no field")]
)
def test_fields_that_are_not_there_are_told_with_those_that_are(field, complaint):
    (function,) = read_chain(["on", field])
    with pytest.raises(click.UsageError, match=complaint):
        build_message(function, LedFunction)
