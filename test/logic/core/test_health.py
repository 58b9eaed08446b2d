"""What a module reports about itself."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.core.health import GoalCounter, Level, connection_report, launch_report
from nao_library_modules.core.processes import Status, SupervisorState
from naoqi.limits import Timing

SILENT = "silent: goals and calls wait, until the robot is lost after 10 s without an answer"


@pytest.mark.parametrize(
    "facts, level, text",
    [
        ({}, Level.OK, "connected"),
        ({"latency": 0.8}, Level.WARN, "connected, but answers take 0.8 s"),
        ({"silent": 3.2}, Level.WARN, SILENT),
        ({"state": "connecting"}, Level.ERROR, "connecting: no answer yet"),
        ({"state": "lost", "last_error": "refused"}, Level.ERROR, "lost: refused"),
    ],
)
def test_connection(facts, level, text):
    connection = {"state": "connected", "latency": 0.002, "silent": 0.0, "generation": 1, "last_error": None, **facts}
    connection["timing"] = Timing(patience=10.0)
    report = connection_report("10.0.0.7:9559", SimpleNamespace(**connection))
    assert (report.level, report.message, report.values["address"]) == (level, text, "10.0.0.7:9559")
    assert report.values["latency (ms)"] == (f"{1000 * connection['latency']:.1f}")
    assert report.values["state"] == ("silent" if connection["silent"] else connection["state"])


def test_goals_are_counted_by_their_end_and_the_last_error_is_kept():
    counter = GoalCounter()
    error = "function 1 (on): no light"
    for end in (("succeeded", ""), ("aborted", error), ("succeeded", ""), ("preempted", "preempted")):
        counter.ended(*end)
    report = counter.report()
    assert report.level is Level.OK
    assert report.values == {"succeeded": "2", "preempted": "1", "aborted": "1", "last error": error}


@pytest.mark.parametrize(
    "status, level, text",
    [
        (Status(SupervisorState.RUNNING, 7, 0, ""), Level.OK, "running"),
        (Status(SupervisorState.RUNNING, 7, 2, "ended"), Level.WARN, "running"),
        (
            Status(SupervisorState.WAITING, None, 0, "ended by itself"),
            Level.ERROR,
            "ended by itself; it is started again",
        ),
        (Status(SupervisorState.STOPPED, None, 0, ""), Level.WARN, "not started"),
    ],
)
def test_launch_file(status, level, text):
    report = launch_report(SimpleNamespace(status=status))
    assert (report.level, report.message) == (level, text)
    assert launch_report(None).level is Level.OK, "one that the module has not started is no problem"
