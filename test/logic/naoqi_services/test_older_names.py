"""Names of NAOqi before 2.8: what the data says of them, and what comes of a call."""

from __future__ import annotations

import logging
import re

import pytest

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.api import FILE, OLDER_FILE, module_methods, qi_type
from nao_sim_bridge.naoqi.binding.older import older_events, older_methods, warning_once

TABLES = read_json(config_file(OLDER_FILE))
METHODS = [(module, name) for module, methods in TABLES["methods"].items() for name in methods]
ENTRY = {"last", "returns", "summary", "ways", "pick", "answer", "refuses"}


def placeholders(template):
    """Names of the parameters that a template of an argument takes."""
    if isinstance(template, str):
        return {template[1:]} if template.startswith("$") else set()
    if isinstance(template, (list, dict)):
        return set().union(*map(placeholders, template))
    return set()


@pytest.mark.parametrize("module, name", METHODS)
def test_an_older_method_is_none_of_today_and_calls_some_of_today_as_they_are_called(module, name):
    entry, today = TABLES["methods"][module][name], module_methods(module)
    assert set(entry) <= ENTRY and re.fullmatch(r"\d\.\d+", entry["last"]) and name not in today
    assert qi_type(entry["returns"]) and entry["summary"]
    older = older_methods(module)[name]
    assert len({len(overload.names) for overload in older.method.overloads}) == len(older.method.overloads)
    for overload, calls in zip(older.method.overloads, older.calls):
        assert overload.signature
        for target, *templates in calls:
            assert len(templates) in {len(way.types) for way in today[target].overloads}
            assert placeholders(templates) <= set(overload.names)
        assert set(older.refuses) <= set(overload.names)
        untold = set(overload.names) - placeholders(calls) - set(older.refuses)
        assert not older.calls or untold <= set(re.findall(r"\w+", older.method.summary.partition("not used:")[2]))


def test_modules_and_events_that_are_no_more_have_names_that_are():
    known = {name for name in read_json(config_file(FILE)) if not name.startswith("_")}
    for module, entry in TABLES["modules"].items():
        assert re.fullmatch(r"\d\.\d+", entry["_last"])
        assert set(re.findall(r"AL\w+", entry["_now"])) <= known
        own = [method for name, method in module_methods(module).items() if name in entry]
        assert all(method.older for method in own) and (own or module in known)
    events = read_json(config_file("naoqi_events.json"))["events"]
    assert older_events() and set(older_events()) <= set(events)


class Module:
    """Remembers calls by name; `answers` are what they give."""

    def __init__(self, **answers):
        self.calls, self.answers = [], answers

    def __getitem__(self, name):
        def call(*arguments):
            self.calls.append((name, *arguments))
            return self.answers.get(name)

        return call


def test_arguments_go_where_they_belong_today():
    body = Module()
    for name, *arguments in (
        ("stepTo", "LLeg", 0.04, 0.1, 0.0),
        ("gotoBodyAnglesWithSpeed", [0.0] * 26, 30.0, 1),
        ("setWalkArmsEnable", True, False),
        ("setWalkArmsEnable", False),
    ):
        assert older_methods("ALMotion")[name].bound_to(body)(*arguments) is None
    assert body.calls == [
        ("setFootStepsWithSpeed", ["LLeg"], [[0.04, 0.1, 0.0]], [1.0], False),
        ("angleInterpolationWithSpeed", "Body", [0.0] * 26, pytest.approx(0.3)),
        ("setMoveArmsEnabled", True, False),
        ("setMoveArmsEnabled", False, False),
    ]


def test_what_a_call_of_today_does_not_take_is_told_or_refused():
    assert older_methods("ALMotion")["turn"].method.summary.endswith("; not used: samplesPerStep")
    track = older_methods("ALMotion")["updateTrackerTarget"]
    assert track.method.summary.endswith("rad; not used: pTimeSinceDetectionMs")
    body = Module()
    track.bound_to(body)(0.1, 0.2, 40, False)
    with pytest.raises(BadValue, match="pUseOfWholeBody is True, allowed is False: the head moves alone"):
        track.bound_to(body)(0.1, 0.2, 40, True)
    assert body.calls == [("setAngles", ["HeadYaw", "HeadPitch"], [0.2, 0.1], 0.3)]


def test_of_a_list_the_answer_may_be_one_entry():
    assert older_methods("ALMotion")["getAngle"].bound_to(Module(getAngles=[0.25]))("HeadYaw") == 0.25


def test_an_answer_waits_for_what_a_call_leads_to():
    first, second = Task("subscribe", 1), Task("subscribe", 2)
    answer = older_methods("ALAudioDevice")["subscribeRemoteModule"].bound_to(Module(subscribe=first))("Ears")
    first.finish(second)
    inner = answer.value
    assert answer.finished and not inner.finished
    second.finish(None)
    assert inner.value is True


def test_calls_follow_each_other_and_an_error_ends_them():
    closing = Task("closeAudioOutputs", 1)
    device = Module(closeAudioOutputs=closing)
    answer = older_methods("ALAudioDevice")["resetAudio"].bound_to(device)()
    assert [name for name, *_ in device.calls] == ["closeAudioOutputs"]
    closing.finish(error=ValueError("stuck"))
    assert str(answer.error) == "stuck" and len(device.calls) == 1


def test_only_the_first_call_of_an_older_name_is_told(caplog):
    with caplog.at_level(logging.WARNING):
        for name in ("walkTo", "moveTo"):
            call = warning_once("ALMotion", module_methods("ALMotion")[name], list)
            assert call("ab") == call("ab") == ["a", "b"]
    assert [record.getMessage() for record in caplog.records] == [
        "ALMotion.walkTo is an older name: deprecated, see moveTo"
    ]
