"""Waiting for calls to the robot."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.errors import Preempted
from nao_library_modules.interrupt import Interrupt
from nao_library_modules.robot import wait_for_calls
from naoqi.errors import RobotError


def in_background(calls, interrupt):
    """Wait in a thread; the outcome is appended to the list that comes back."""
    outcome = []

    def wait():
        try:
            outcome.append(wait_for_calls(calls, interrupt))
        except Exception as error:
            outcome.append(error)

    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    return thread, outcome


def test_results_come_in_the_order_of_the_calls(make_call):
    calls = [make_call(), make_call(), make_call()]
    thread, outcome = in_background(calls, Interrupt())
    for i in (2, 0, 1):
        calls[i].end(f"result {i}")
    thread.join(5.0)
    assert outcome == [["result 0", "result 1", "result 2"]]


def test_no_calls_need_no_waiting():
    assert wait_for_calls([], Interrupt()) == []


def test_an_interrupt_cancels_every_call_that_still_runs(make_call):
    calls = [make_call(), make_call(), make_call()]
    calls[1].end("done before")
    interrupt = Interrupt()
    thread, outcome = in_background(calls, interrupt)
    interrupt.trigger()
    thread.join(5.0)
    assert isinstance(outcome[0], Preempted)
    assert [call.canceled for call in calls] == [True, False, True]


def test_the_first_failure_cancels_the_others_and_is_raised(make_call):
    calls = [make_call(), make_call()]
    thread, outcome = in_background(calls, Interrupt())
    calls[1].end(error=RobotError("ALLeds", "fade", "no such LED"))
    thread.join(5.0)
    assert isinstance(outcome[0], RobotError)
    assert calls[0].canceled


def test_calls_that_are_done_count_even_after_an_interrupt(make_call):
    call = make_call()
    call.end("done")
    interrupt = Interrupt()
    interrupt.trigger()
    assert wait_for_calls([call], interrupt) == ["done"]


def test_a_robot_that_cannot_cancel_delays_preemption_by_a_bounded_time(make_call, monkeypatch):
    monkeypatch.setattr("nao_library_modules.robot.CANCEL_LIMIT", 0.02)
    call = make_call()
    call.cancel = lambda: None
    interrupt = Interrupt()
    interrupt.trigger()
    with pytest.raises(Preempted):
        wait_for_calls([call], interrupt)
