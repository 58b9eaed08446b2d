"""Memory functions, as goals of a module."""

from __future__ import annotations

import json

import pytest

from nao_library_actions.msg import NaoLedGoal
from nao_library_modules.errors import BadGoal
from nao_library_modules.memory_functions import parse_assignment, parse_keys
from nao_library_msgs.msg import LedFunction


def play(lights, *functions):
    return lights.server.play(NaoLedGoal([LedFunction(function=f, str_param=p) for f, p in functions]))


@pytest.mark.parametrize(
    "text, key, value",
    [
        ("Level=0.5", "Level", 0.5),
        ("Angles=[1, 2.5]", "Angles", [1, 2.5]),
        ("Word=hello there", "Word", "hello there"),
        ('Word="7"', "Word", "7"),
        ("Empty=", "Empty", ""),
        ("Sum = a=b", "Sum", " a=b"),
        ("On=true", "On", True),
    ],
)
def test_assignments_hold_json_or_plain_text(text, key, value):
    assert parse_assignment(text) == (key, value)


@pytest.mark.parametrize("text", ["", "Level", "=0.5", " =0.5"])
def test_assignments_without_key_or_sign_are_refused(text):
    with pytest.raises(BadGoal, match="'key=value'"):
        parse_assignment(text)


def test_keys_are_separated_by_commas():
    assert parse_keys("A, B ,,C") == ["A", "B", "C"]


def test_answers_come_in_mem_list_in_the_order_of_the_chain(lights):
    server = play(lights, ("getData", "Name"), ("getListData", "Level, Angles, Nothing"), ("ping", ""))
    assert server.end == "succeeded"
    assert server.result.memList == ["nao", "0.25", "[0.5, 1.0]", "None", "True"]
    assert [result.function for result in server.result.results] == ["getData", "getListData", "ping"]
    assert server.result.results[1].values == ["0.25", "[0.5, 1.0]", "None"]


def test_a_list_of_keys_gives_one_string_a_key(lights):
    assert play(lights, ("getDataList", "e")).result.memList == ["Name", "Angles", "Level"]


def test_values_are_written_with_their_types(lights, robot):
    assert play(lights, ("insertData", "Level=0.75"), ("raiseEvent", 'Said={"word": "yes"}')).end == "succeeded"
    assert robot.memory.data["Level"] == 0.75
    assert robot.memory.data["Said"] == {"word": "yes"}


def test_what_the_robot_refuses_aborts_the_goal_with_its_text(lights):
    server = play(lights, ("getData", "Name"), ("getData", "Nothing"))
    assert server.end == "aborted"
    assert server.text == "function 2 (getData): ALMemory.getData failed: no data Nothing"
    assert server.result.memList == ["nao"]


@pytest.mark.parametrize(
    "function, argument, text",
    [
        ("getData", " ", "field str_param: it is empty"),
        ("getListData", ",", "field str_param: it names no key"),
        ("insertData", "Level", "field str_param: 'Level' is not allowed: 'key=value'"),
        ("raiseEvent", "", "'key=value'"),
        ("subscribeToEvent", "", "field str_param: it is empty"),
    ],
)
def test_bad_arguments_stop_the_chain_before_it_begins(lights, robot, function, argument, text):
    server = play(lights, ("removeData", "Name"), (function, argument))
    assert server.end == "aborted"
    assert server.text.startswith(f"function 2 ({function}): ")
    assert text in server.text
    assert "Name" in robot.memory.data


def test_events_are_passed_on_from_subscription_to_its_end(lights, robot, edge):
    assert play(lights, ("subscribeToEvent", "FrontTactilTouched")).end == "succeeded"
    signal = robot.memory.signals["FrontTactilTouched"]
    signal(1.0)
    play(lights, ("unsubscribeToEvent", "FrontTactilTouched"))
    signal(0.0)
    assert edge.events == [("FrontTactilTouched", 1.0)]


def test_all_memory_functions_are_in_the_table_of_a_module(lights):
    documented = """getData getListData getDataList getEventList getMicroEventList getEventHistory getType
        getTimestamp insertData removeData raiseEvent raiseMicroEvent subscribeToEvent unsubscribeToEvent
        ping"""
    assert set(documented.split()) <= set(lights.function_table)


def test_json_in_mem_list_can_be_read_back(lights):
    (text,) = play(lights, ("getData", "Angles")).result.memList or [None]
    assert json.loads(text) == [0.5, 1.0]
