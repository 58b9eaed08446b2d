"""Waiting for calls to the robot: a call is what the proxy layer gives for one that is under way."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules import robot
from nao_library_modules.errors import Preempted, RobotLost
from nao_library_modules.interrupt import Interrupt
from nao_library_modules.robot import wait_for_calls
from nao_library_modules.robot_task import run_task
from naoqi.errors import CallCanceled, RobotError

LIMIT = 15.0


class Call:
    """A call that ends when the test says so."""

    def __init__(self, cancels=True):
        self.canceled, self._cancels = False, cancels
        self._ended, self._callbacks, self._outcome = threading.Event(), [], (None, None)

    def end(self, result=None, error=None):
        if not self._ended.is_set():
            self._outcome = result, error
            self._ended.set()
            for callback in self._callbacks:
                callback(self)

    def add_done_callback(self, callback):
        self._callbacks.append(callback)
        if self._ended.is_set():
            callback(self)

    def done(self):
        return self._ended.is_set()

    def wait(self, timeout=None):
        return self._ended.wait(timeout)

    def result(self, timeout=None):
        assert self._ended.wait(timeout), "nobody ended this call"
        result, error = self._outcome
        if error is not None:
            raise error
        return result

    def cancel(self):
        self.canceled = True
        if self._cancels:
            self.end(error=CallCanceled("ALLeds", "fade"))


def start(function, *arguments):
    """Run a function in a thread; gives what waits for its value or error."""
    outcome = []

    def run():
        try:
            outcome.append(function(*arguments))
        except Exception as error:
            outcome.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    return lambda: thread.join(LIMIT) or outcome[0]


def never():
    raise AssertionError("the call ended by being cancelled, so nothing else needs to stop it")


def test_results_come_in_the_order_of_the_calls():
    calls = [Call() for _ in range(3)]
    end = start(wait_for_calls, calls, Interrupt())
    for i in (2, 0, 1):
        calls[i].end(f"result {i}")
    assert end() == ["result 0", "result 1", "result 2"] and wait_for_calls([], Interrupt()) == []


def test_an_interrupt_or_the_first_failure_cancels_every_call_that_still_runs():
    calls, interrupt = [Call() for _ in range(3)], Interrupt()
    calls[1].end("done before")
    end = start(wait_for_calls, calls, interrupt)
    interrupt.trigger()
    assert isinstance(end(), Preempted) and [call.canceled for call in calls] == [True, False, True]
    calls = [Call(), Call()]
    end = start(wait_for_calls, calls, Interrupt())
    calls[1].end(error=RobotError("ALLeds", "fade", "no such LED"))
    assert isinstance(end(), RobotError) and calls[0].canceled


def test_calls_that_are_done_count_even_after_an_interrupt():
    call, interrupt = Call(), Interrupt()
    call.end("done")
    interrupt.trigger()
    assert wait_for_calls([call], interrupt) == ["done"] and run_task(call, interrupt, never) == "done"


def test_a_robot_that_cannot_cancel_delays_preemption_by_a_bounded_time_or_is_stopped_by_other_means(monkeypatch):
    monkeypatch.setattr(robot, "CANCEL_LIMIT", 0.02)
    interrupt = Interrupt()
    interrupt.trigger()
    with pytest.raises(Preempted):
        wait_for_calls([Call(cancels=False)], interrupt)
    call = Call(cancels=False)
    with pytest.raises(Preempted):
        run_task(call, interrupt, lambda: call.end("killed"))


@pytest.mark.parametrize("reason", [None, RobotLost("nao:9559", "silence")])
def test_a_task_gives_its_result_its_error_or_the_reason_of_an_interrupt(reason):
    call, broken, interrupt = Call(), Call(), Interrupt()
    end = start(run_task, call, interrupt, never)
    call.end("there")
    assert end() == "there"
    broken.end(error=RobotError("ALMotion", "angleInterpolation", "no"))
    with pytest.raises(RobotError, match="no"):
        run_task(broken, interrupt, never)
    call = Call()
    end = start(run_task, call, interrupt, never)
    interrupt.trigger(reason)
    assert isinstance(end(), type(reason or Preempted())) and call.canceled
