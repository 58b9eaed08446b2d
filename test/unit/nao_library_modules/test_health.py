"""What a module reports about itself."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.health import GoalCounter, Level, connection_report, launch_report
from nao_library_modules.supervisor import State, Status


def connection(**facts):
    return SimpleNamespace(**{"state": "connected", "latency": 0.002, "generation": 1, "last_error": None, **facts})


@pytest.mark.parametrize(
    "facts, level, text",
    [
        ({}, Level.OK, "connected"),
        ({"latency": None}, Level.OK, "connected"),
        ({"latency": 0.8}, Level.WARN, "connected, but answers take 0.8 s"),
        ({"state": "connecting"}, Level.ERROR, "connecting: no answer yet"),
        ({"state": "lost", "last_error": "refused"}, Level.ERROR, "lost: refused"),
    ],
)
def test_connection(facts, level, text):
    report = connection_report("10.0.0.7:9559", connection(**facts))
    assert (report.level, report.message) == (level, text)
    assert report.values["address"] == "10.0.0.7:9559"


def test_latency_is_told_in_ms():
    assert connection_report("a:1", connection()).values["latency (ms)"] == "2.0"
    assert connection_report("a:1", connection(latency=None)).values["latency (ms)"] == ""


def test_goals_are_counted_by_their_end_and_the_last_error_is_kept():
    counter = GoalCounter()
    counter.ended("succeeded", "")
    counter.ended("aborted", "function 1 (on): no light")
    counter.ended("succeeded", "")
    counter.ended("preempted", "preempted")
    report = counter.report()
    assert report.level is Level.OK
    assert report.values == {
        "succeeded": "2",
        "preempted": "1",
        "aborted": "1",
        "last error": "function 1 (on): no light",
    }


@pytest.mark.parametrize(
    "status, level, text",
    [
        (Status(State.RUNNING, 7, 0, ""), Level.OK, "running"),
        (Status(State.RUNNING, 7, 2, "ended"), Level.WARN, "running"),
        (
            Status(State.WAITING, None, 0, "ended by itself"),
            Level.ERROR,
            "ended by itself; it is started again",
        ),
        (Status(State.STOPPED, None, 0, ""), Level.WARN, "not started"),
    ],
)
def test_launch_file(status, level, text):
    report = launch_report(SimpleNamespace(status=status))
    assert (report.level, report.message) == (level, text)


def test_a_launch_file_that_the_module_has_not_started_is_no_problem():
    assert launch_report(None).level is Level.OK
