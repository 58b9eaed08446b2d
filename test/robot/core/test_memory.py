"""The memory functions that every module has, and events that go from the robot's memory to a topic."""

from __future__ import annotations

import json

from goal_functions import led_with_text as f

from nao_library_modules.core.memory_functions import parse_assignment


def ask(lights, *calls):
    return lights.succeed(*(f(*call) for call in calls)).memList


def test_data_goes_in_and_out_with_its_type(robot, lights):
    answers = ask(lights, ("insertData", 'Test/Answer=[1, 2.5, "three"]'), ("getData", " Test/Answer "))
    assert json.loads(answers[-1]) == robot.value("Test/Answer") == [1, 2.5, "three"]
    assert ask(lights, ("getDataList", "Test/An")) == ["Test/Answer"]
    assert ask(lights, ("getType", "Test/Answer")) == ["Data"]
    value, seconds, microseconds = ask(lights, ("getTimestamp", "Test/Answer"))
    assert json.loads(value) == [1, 2.5, "three"] and int(seconds) >= 0 and 0 <= int(microseconds) < 1e6
    ask(lights, ("removeData", "Test/Answer"))
    assert ask(lights, ("getDataList", "Test/An")) == []


def test_events_raised_through_a_goal_reach_the_robot(robot, lights):
    heard, micro = robot.heard("Test/FromGoal"), robot.heard("Test/Micro")
    ask(lights, ("raiseEvent", 'Test/FromGoal={"word": "yes"}'), ("raiseMicroEvent", "Test/Micro=true"))
    assert (heard.get(timeout=60.0), micro.get(timeout=60.0)) == ({"word": "yes"}, True)
    assert "Test/FromGoal" in ask(lights, ("getEventList",))
    assert "Test/Micro" in ask(lights, ("getMicroEventList",))
    (entry,) = ask(lights, ("getEventHistory", "Test/FromGoal"))
    assert json.loads(entry)[0] == {"word": "yes"}


def test_events_are_declared_described_listed_mapped_and_removed(robot, lights):
    ask(lights, ("declareEvent", "Test/Wave=Waver"), ("setDescription", "Test/Wave=somebody waves"))
    assert ask(lights, ("getExtractorEvent", "Waver")) == ["Test/Wave"]
    assert json.loads(ask(lights, ("getDescriptionList", "Test/Wave"))[0])[-1] == "somebody waves"
    ask(lights, ("subscribeToEvent", "Test/Wave"))
    assert ask(lights, ("getSubscribers", "Test/Wave")) == robot.ALMemory.getSubscribers("Test/Wave")
    ask(lights, ("removeEvent", "Test/Wave"), ("raiseMicroEvent", "Test/Nod=1"), ("removeMicroEvent", "Test/Nod"))
    names = ask(lights, ("getEventList",), ("getMicroEventList",))
    assert not {"Test/Wave", "Test/Nod"} & set(names)


def test_a_signal_of_a_service_becomes_an_event(robot, lights):
    ask(lights, ("addMapping", "ALTactileGesture.onGesture=Test/Gesture"))
    heard = robot.heard("Test/Gesture")
    for sensors in (["Head/Touch/Front"], []):
        robot.server.press(sensors)
        robot.advance(0.2)
    robot.advance(1.0)
    assert heard.get(timeout=60.0) == "SingleFront"


def test_several_keys_are_written_at_once_and_one_is_waited_for(robot, lights):
    ask(lights, ("insertListData", '{"Test/A": 1, "Test/B": [2]}'), ("insertListData", '[["Test/C", "three"]]'))
    assert ask(lights, ("getListData", "Test/A, Test/B, Test/C")) == ["1", "[2]", "three"]
    assert {"Test/A", "Test/B"} <= set(ask(lights, ("getDataListName",)))
    goal = lights.send(f("getDataOnChange", "Test/A"))
    robot.advance(0.5)
    robot.ALMemory.insertData("Test/A", 5)
    assert goal.finish().result.memList == ["5"]


def events_until(robot, events, last):
    """Raise `last` and wait for it; the events before it, which came in order."""
    robot.ALMemory.raiseEvent(last, 0)
    robot.advance_until(lambda: (last, 0) in events, 15.0, what=last)
    return [event for event in events if event[0] != last]


def test_micro_events_are_passed_on_as_well(robot, lights):
    ask(lights, ("subscribeToMicroEvent", "Test/Micro"), ("subscribeToEvent", "Last"))
    robot.ALMemory.raiseMicroEvent("Test/Micro", 1)
    assert events_until(robot, lights.node.events, "Last") == [("Test/Micro", 1)]


def test_events_are_passed_on_from_subscription_to_its_end(robot, lights):
    ask(lights, ("subscribeToEvent", "Test/Event"), ("subscribeToEvent", "Test/Event"), ("subscribeToEvent", "Last"))
    robot.ALMemory.raiseEvent("Test/Event", [1, "a"])
    events = lights.node.events
    assert events_until(robot, events, "Last") == [("Test/Event", [1, "a"])]
    ask(lights, ("unsubscribeToEvent", "Test/Event"), ("unsubscribeToEvent", "Nobody"))
    assert lights.module.events.names == ["Last"]
    robot.ALMemory.raiseEvent("Test/Event", 2)
    events.clear()
    assert events_until(robot, events, "Last") == []


def test_bad_arguments_stop_the_chain_before_it_begins(robot, lights):
    for function, argument, text in (
        ("getData", " ", "field str_param: it is empty"),
        ("getListData", ",", "field str_param: it names no key"),
        ("insertData", "Level", "field str_param: 'Level' is not allowed: 'key=value'"),
        ("raiseEvent", "", "'key=value'"),
        ("raiseMicroEvent", "=1", "'key=value'"),
        ("insertListData", '{"": 1}', 'JSON: {"key": value, ...}'),
        ("addMapping", "ALLeds=Test/Event", "'service.signal=event'"),
        *((name, "", "it is empty") for name in ("getEventHistory", "getType", "getTimestamp", "removeData")),
        *((name, "", "it is empty") for name in ("subscribeToEvent", "unsubscribeToEvent")),
    ):
        refusal = lights.refused(f("insertData", "Test/Key=1"), f(function, argument))
        assert refusal.startswith(f"function 2 ({function}): ") and text in refusal
    assert robot.ALMemory.getDataList("Test/Key") == []


def test_assignments_hold_json_or_plain_text():
    for text, key, value in (
        ("Level=0.5", "Level", 0.5), ("Angles=[1, 2.5]", "Angles", [1, 2.5]), ("On=true", "On", True),
        ("Word=hello there", "Word", "hello there"), ('Word="7"', "Word", "7"), ("Empty=", "Empty", ""),
        ("Sum = a=b", "Sum", " a=b"),
    ):  # fmt: skip
        assert parse_assignment(text) == (key, value)
