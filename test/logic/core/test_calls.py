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
        self.canceled = False
        self._cancels = cancels
        self._ended = threading.Event()
        self._callbacks = []
        self._outcome = None, None

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


@pytest.fixture
def waiting():
    """Runs a function in a thread; gives what ends the wait for it: its value or error."""

    def start(function, *arguments):
        outcome = []

        def run():
            try:
                outcome.append(function(*arguments))
            except Exception as error:
                outcome.append(error)

        thread = threading.Thread(target=run, daemon=True)
        thread.start()

        def end():
            thread.join(LIMIT)
            return outcome[0]

        return end

    return start


def never():
    raise AssertionError("the call ended by being cancelled, so nothing else needs to stop it")


def test_results_come_in_the_order_of_the_calls(waiting):
    calls = [Call() for _ in range(3)]
    end = waiting(wait_for_calls, calls, Interrupt())
    for i in (2, 0, 1):
        calls[i].end(f"result {i}")
    assert end() == ["result 0", "result 1", "result 2"]
    assert wait_for_calls([], Interrupt()) == []


def test_an_interrupt_cancels_every_call_that_still_runs(waiting):
    calls, interrupt = [Call() for _ in range(3)], Interrupt()
    calls[1].end("done before")
    end = waiting(wait_for_calls, calls, interrupt)
    interrupt.trigger()
    assert isinstance(end(), Preempted)
    assert [call.canceled for call in calls] == [True, False, True]


def test_the_first_failure_cancels_the_others_and_is_raised(waiting):
    calls = [Call(), Call()]
    end = waiting(wait_for_calls, calls, Interrupt())
    calls[1].end(error=RobotError("ALLeds", "fade", "no such LED"))
    assert isinstance(end(), RobotError) and calls[0].canceled


def test_calls_that_are_done_count_even_after_an_interrupt():
    call, interrupt = Call(), Interrupt()
    call.end("done")
    interrupt.trigger()
    assert wait_for_calls([call], interrupt) == ["done"]
    assert run_task(call, interrupt, never) == "done"


def test_a_robot_that_cannot_cancel_delays_preemption_by_a_bounded_time(monkeypatch):
    monkeypatch.setattr(robot, "CANCEL_LIMIT", 0.02)
    interrupt = Interrupt()
    interrupt.trigger()
    with pytest.raises(Preempted):
        wait_for_calls([Call(cancels=False)], interrupt)


def test_a_task_gives_its_result_or_raises_its_error(waiting):
    call = Call()
    end = waiting(run_task, call, Interrupt(), never)
    call.end("there")
    assert end() == "there"
    broken = Call()
    broken.end(error=RobotError("ALMotion", "angleInterpolation", "no"))
    with pytest.raises(RobotError, match="no"):
        run_task(broken, Interrupt(), never)


@pytest.mark.parametrize("reason", [None, RobotLost("nao:9559", "silence")])
def test_an_interrupt_cancels_a_task_and_tells_its_reason(waiting, reason):
    call, interrupt = Call(), Interrupt()
    end = waiting(run_task, call, interrupt, never)
    interrupt.trigger(reason)
    assert isinstance(end(), type(reason or Preempted())) and call.canceled


def test_a_task_that_cannot_be_cancelled_is_stopped_by_other_means(waiting):
    call, interrupt = Call(cancels=False), Interrupt()
    end = waiting(run_task, call, interrupt, lambda: call.end("killed"))
    interrupt.trigger()
    assert isinstance(end(), Preempted)
