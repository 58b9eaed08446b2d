"""Calls without waiting: posted in the manner of NAOqi, and as objects."""

from __future__ import annotations

import gc
import threading
import weakref

import pytest

from naoqi import calls, errors


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
    proxy.stop(task)  # a second time is no error


def test_another_proxy_of_the_same_robot_can_wait_for_a_posted_call(robot, proxy, begun):
    task = proxy.post.begin()
    begun()
    proxy.finish(1)
    assert robot.proxy("ALMemory").wait(task) is False


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


def test_finished_calls_leave_nothing_behind(proxy, eventually):
    for task in [proxy.post.add(number, 1) for number in range(50)]:
        assert proxy.wait(task) is False
    with pytest.raises(errors.RobotError):
        proxy.wait(proxy.post.fails())
    proxy.call_async("fails").add_done_callback(lambda _: 1 / 0)
    presence = proxy.connection.presence
    eventually(lambda: presence.wait_until_empty(0.0), "libqi lets go of all callbacks")


def test_a_call_object_tells_when_it_is_done(proxy, begun, patience):
    done = threading.Event()
    call = proxy.call_async("begin")
    call.add_done_callback(lambda ended: done.set() if ended is call else None)
    begun()
    assert not call.done()
    with pytest.raises(errors.CallTimeout):
        call.result(timeout=0.02)
    proxy.finish("now")
    assert done.wait(patience)
    assert call.done()
    assert call.result() == "now"


def test_a_callback_added_late_is_called_all_the_same(proxy, patience):
    call = proxy.call_async("add", 1, 1)
    call.result()
    done = threading.Event()
    call.add_done_callback(lambda _: done.set())
    assert done.wait(patience)


def test_a_failing_callback_is_logged(proxy, caplog, eventually):
    proxy.call_async("add", 1, 1).add_done_callback(lambda _: 1 / 0)
    eventually(lambda: "ZeroDivisionError" in caplog.text, "the trace is logged")


def test_a_cancelled_call_says_so(proxy, begun, patience):
    call = proxy.call_async("begin")
    begun()
    call.cancel()
    with pytest.raises(errors.CallCanceled, match="ALTest.begin"):
        call.result(timeout=patience)
    assert call.cancelled()


def test_errors_come_with_the_result(proxy):
    with pytest.raises(errors.BadArguments):
        proxy.call_async("add", 1).result()
    with pytest.raises(errors.RobotError):
        proxy.call_async("fails").result()
    with pytest.raises(errors.UnknownMethod):
        proxy.call_async("subtract")


def test_methods_hidden_by_the_face_of_the_proxy_can_be_called_by_name(robot):
    assert robot.proxy("ALNao").call_async("stop", 1).result() == "stopped 1"


def test_a_remote_error_that_speaks_like_libqi_is_no_timeout(proxy, begun):
    call = proxy.call_async("begin")
    begun()
    proxy.breakDown("Future timeout.")
    with pytest.raises(errors.RobotError):
        call.result()


def test_many_threads_share_a_proxy(proxy, in_thread):
    finishes = [in_thread(lambda n=n: [proxy.add(n, k) for k in range(50)]) for n in range(8)]
    for n, finish in enumerate(finishes):
        assert finish()["value"] == [n + k for k in range(50)]


class Asker:
    """Who waits for an answer, and may hold a lot."""


def test_the_error_of_a_call_that_took_its_time_keeps_nobody(proxy, begun, monkeypatch):
    """The error keeps the frames that it went through: none of them may keep it."""
    monkeypatch.setattr(calls, "FIRST_SLICE_MS", 0)  # to be in the long wait at once

    def ask():
        asker = Asker()
        askers.append(weakref.ref(asker))
        call = proxy.call_async("begin")
        begun()
        breaking = threading.Timer(0.1, proxy.breakDown, ("lost a screw",))
        breaking.start()
        call.result()

    askers = []
    gc.collect()
    gc.disable()
    try:
        with pytest.raises(errors.RobotError, match="lost a screw"):
            ask()
        assert askers[0]() is None
    finally:
        gc.enable()
