"""Long calls that end when they must."""

from __future__ import annotations

import pytest

from nao_library_modules.errors import Preempted, RobotLost
from nao_library_modules.interrupt import Interrupt
from nao_library_modules.robot_task import run_task
from naoqi.errors import RobotError


def never():
    raise AssertionError("the call ended by being cancelled, so nothing else needs to stop it")


def test_a_call_that_ends_gives_its_result(make_call, in_thread):
    call = make_call()
    thread, outcome = in_thread(run_task, call, Interrupt(), never)
    call.end("there")
    thread.join(5.0)
    assert outcome == ["there"]


def test_an_error_of_the_robot_is_raised(make_call):
    call = make_call()
    call.end(error=RobotError("ALMotion", "angleInterpolation", "no"))
    with pytest.raises(RobotError, match="no"):
        run_task(call, Interrupt(), never)


@pytest.mark.parametrize("reason", [None, RobotLost("nao:9559", "silence")])
def test_an_interrupt_cancels_the_call_and_tells_its_reason(make_call, in_thread, reason):
    call, interrupt = make_call(), Interrupt()
    thread, outcome = in_thread(run_task, call, interrupt, never)
    interrupt.trigger(reason)
    thread.join(5.0)
    assert call.canceled
    assert isinstance(outcome[0], type(reason or Preempted()))


def test_what_cannot_be_cancelled_is_stopped_by_other_means(make_call, in_thread):
    call, interrupt = make_call(), Interrupt()
    call.cancel = lambda: None  # as on a robot that does not know cancellation
    thread, outcome = in_thread(run_task, call, interrupt, lambda: call.end("killed"))
    interrupt.trigger()
    thread.join(5.0)
    assert isinstance(outcome[0], Preempted)


def test_an_interrupt_after_the_end_changes_nothing(make_call):
    call, interrupt = make_call(), Interrupt()
    call.end("there")
    interrupt.trigger()
    assert run_task(call, interrupt, never) == "there"
