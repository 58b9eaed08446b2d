"""Function messages from fields, and back."""

from __future__ import annotations

import random
import re

import genpy
import pytest
import roslib.message
import yaml

from nao_library_modules.behaviors.messages import fields_of, message_of
from nao_library_modules.behaviors.servers import NAMES, server_of
from nao_library_modules.behaviors.yaml_text import dump, load
from nao_library_modules.errors import BadGoal
from nao_library_msgs.msg import LedFunction, MotionFunction


def test_fields_become_what_they_are_in_the_message():
    fields = {
        "names": ["HeadYaw"],
        "angles": [1, 0.5],
        "time": 1.3,
        "str_param": 4,
        "limp": True,
        "trajectory": {"joint_names": ["a"], "points": [{"positions": [1], "time_from_start": 0.7}]},
    }
    message = message_of(MotionFunction, fields)
    assert (message.angles, message.str_param, message.limp) == ([1.0, 0.5], "4", True)
    assert message.time == genpy.Duration(1, 300000000)
    assert message.trajectory.points[0].time_from_start == genpy.Duration(0, 700000000)


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"light": []}, "did you mean 'lights'"),
        ({"lights": "FaceLeds"}, "a list: [FaceLeds]"),
        ({"lights": [["a"]]}, "lights[0]"),
        ({"str_param": True}, "is no text"),
        ({"str_param": None}, "a text"),
        ({"i_values": ["1"]}, "i_values[0]"),
        ({"i_values": [float("nan")]}, "finite"),
        ({"i_values": [10**400]}, "finite"),
        ({"revert": 1}, "true or false"),
        ({"angle": 1.5}, "a whole number"),
        ({"angle": 2**31}, "-2147483648..2147483647"),
        ({"angle": True}, "a whole number"),
        ({"time": 1e12}, "2147483648"),
        ({"time": "1"}, "a number"),
        ({3: 4}, "no field 3"),
    ],
)
def test_values_of_the_wrong_kind_are_refused(fields, told):
    with pytest.raises(BadGoal) as caught:
        message_of(LedFunction, fields)
    assert told in str(caught.value)


def test_unknown_fields_inside_of_fields_are_named_with_their_path():
    with pytest.raises(BadGoal, match=r"trajectory\.points\[0\]\.position"):
        message_of(MotionFunction, {"trajectory": {"points": [{"position": [1]}]}})


def a_value(kind, chance):
    if kind.endswith("[]"):
        return [a_value(kind[:-2], chance) for _ in range(chance.randrange(3))]
    if kind == "string":
        return chance.choice(["", "a", "on", "${x}", "3", "1e3", "1:30", "010", "~", "2024-01-01", "ä\n#: '\"", " x "])
    if kind == "bool":
        return chance.random() < 0.5
    if kind in ("time", "duration"):
        type_ = genpy.Time if kind == "time" else genpy.Duration
        return type_(chance.randrange(100), chance.randrange(10**9))
    if kind.startswith("float"):
        return chance.choice([0.0, chance.uniform(-9, 9), 1e-12, 1e22])
    if re.fullmatch(r"u?int\d+", kind):
        return chance.randrange(100)
    return a_message(roslib.message.get_message_class(kind), chance)


def a_message(message_type, chance):
    message = message_type()
    for name, kind in zip(message.__slots__, message._slot_types):
        if chance.random() < 0.6:
            setattr(message, name, a_value(kind, chance))
    return message


@pytest.mark.parametrize("server", NAMES)
def test_random_messages_come_back_through_a_file(server):
    chance = random.Random(server)
    for _ in range(40):
        message = a_message(server_of(server).function, chance)
        text = dump(fields_of(message))
        assert yaml.safe_load(text) == load(text, "test")
        assert message_of(type(message), load(text, "test") or {}) == message
