"""Calls without waiting: posted in the manner of NAOqi, and as objects."""

from __future__ import annotations

import threading

import pytest

from naoqi import errors


def test_a_posted_call_runs_until_it_is_finished(proxy, begun):
    task = proxy.post.begin()
    begun()
    assert isinstance(task, int)
    assert proxy.isRunning(task)
    assert proxy.wait(task, 20) is True
    proxy.finish(5)
    assert proxy.wait(task, 0) is False
    assert not proxy.isRunning(task)


def test_stop_cancels_on_the_robot(proxy, begun):
    before = proxy.cancellations()
    task = proxy.post.begin()
    begun()
    proxy.stop(task)
    assert proxy.wait(task, 0) is False
    assert proxy.cancellations() == before + 1


def test_keyword_arguments_are_left_out_as_by_the_sdk_and_the_log_says_so(proxy, caplog):
    assert proxy.add(1, 2, _async=True) == 3
    assert proxy.wait(proxy.post.add(1, 2, _async=True), 0) is False
    assert caplog.text.count("ALTest.add: _async is left out") == 2


def test_errors_of_posted_calls_are_logged_and_raised_by_wait(proxy, begun, caplog, eventually):
    task = proxy.pCall("begin")
    begun()
    proxy.breakDown("lost a screw")
    with pytest.raises(errors.RobotError, match="lost a screw"):
        proxy.wait(task, 0)
    eventually(lambda: "lost a screw" in caplog.text, "the error is logged")


def test_numbers_of_no_call_are_refused(proxy):
    for method in (proxy.wait, proxy.isRunning, proxy.stop):
        with pytest.raises(errors.BadArguments, match="post.method"):
            method(10**9)


def test_a_call_object_tells_when_it_is_done(proxy, begun):
    done = threading.Event()
    call = proxy.call_async("begin")
    call.add_done_callback(lambda ended: done.set() if ended is call else None)
    begun()
    assert not call.done()
    with pytest.raises(errors.CallTimeout):
        call.result(timeout=0.02)
    proxy.finish("now")
    assert done.wait(60.0)
    assert call.done()
    assert call.result() == "now"


def test_a_failing_callback_is_logged(proxy, caplog, eventually):
    proxy.call_async("add", 1, 1).add_done_callback(lambda _: 1 / 0)
    eventually(lambda: "ZeroDivisionError" in caplog.text, "the trace is logged")


def test_a_cancelled_call_says_so(proxy, begun):
    call = proxy.call_async("begin")
    begun()
    call.cancel()
    with pytest.raises(errors.CallCanceled, match="ALTest.begin"):
        call.result(timeout=60.0)
    assert call.cancelled()


def test_errors_come_with_the_result(proxy):
    with pytest.raises(errors.BadArguments):
        proxy.call_async("add", 1).result()
    with pytest.raises(errors.RobotError):
        proxy.call_async("fails").result()
    with pytest.raises(errors.UnknownMethod):
        proxy.call_async("subtract")
