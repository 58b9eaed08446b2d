"""Tasks: one end, whoever asks for it, and callbacks that hear of it once."""

from __future__ import annotations

import threading

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.tasks import Task, TaskIds, killed_error


@pytest.fixture
def task():
    return Task("glide", 7)


def test_a_task_ends_once_and_keeps_its_first_result(task):
    assert not task.finished and task.value is None
    assert task.finish("first")
    assert not task.finish("second")
    assert not task.kill()
    assert task.finished and not task.killed
    assert task.result(timeout=0) == "first" == task.value


def test_an_error_is_raised_to_who_waits(task):
    task.finish(error=BadValue("speed", -1, "above 0"))
    assert isinstance(task.error, BadValue)
    assert task.value is None
    with pytest.raises(BadValue, match="speed is -1"):
        task.result(timeout=0)


def test_waiting_too_long_names_the_task(task):
    with pytest.raises(TimeoutError, match=r"task glide \(7\) has not ended within 0 s"):
        task.result(timeout=0)


def test_who_waits_in_another_thread_is_woken(task, patience):
    seen = []
    waiting = threading.Thread(target=lambda: seen.append(task.result(patience)))
    waiting.start()
    task.finish(42)
    waiting.join(patience)
    assert seen == [42]


def test_callbacks_hear_of_the_end_once_early_or_late(task):
    heard = []
    task.add_done_callback(lambda done: heard.append(("early", done.value)))
    task.finish(1)
    task.add_done_callback(lambda done: heard.append(("late", done.value)))
    task.finish(2)
    assert heard == [("early", 1), ("late", 1)]


def test_a_kill_drops_the_work_before_anybody_hears_of_the_end():
    order = []
    task = Task("glide", 1, on_kill=lambda done: order.append(("dropped", done.finished)))
    task.add_done_callback(lambda done: order.append(("heard", done.killed)))
    assert task.kill()
    assert order == [("dropped", False), ("heard", True)]
    assert task.killed and task.error is None
    assert "glide (1) was killed" in str(killed_error(task))


def test_a_callback_may_kill_the_task_that_just_ended(task):
    task.add_done_callback(lambda done: done.kill())
    assert task.finish(1)
    assert not task.killed


def test_then_passes_the_result_through_a_function(task):
    after = task.then(lambda value: value * 2)
    assert not after.finished
    task.finish(21)
    assert after.result(timeout=0) == 42


def test_then_passes_an_error_on(task):
    after = task.then(lambda value: value * 2)
    task.finish(error=BadValue("speed", -1, "above 0"))
    with pytest.raises(BadValue):
        after.result(timeout=0)


def test_then_tells_of_a_kill(task):
    after = task.then(bool)
    task.kill()
    assert after.killed
    assert after.result(timeout=0) is False


def test_numbers_start_at_one_for_each_source():
    first, second = TaskIds(), TaskIds()
    assert [first.make("a").task_id, first.make("b").task_id, second.make("c").task_id] == [1, 2, 1]


def test_a_requested_kill_goes_to_who_runs_the_simulation():
    ids, asked = TaskIds(), []
    task = ids.make("glide")
    task.request_kill()
    assert not task.finished
    ids.ask = asked.append
    task.request_kill()
    assert asked == [task]
    assert not task.finished


def test_the_end_of_a_chain_asks_for_the_end_of_its_start():
    ids, asked = TaskIds(), []
    ids.ask = asked.append
    task = ids.make("glide")
    task.then(str).request_kill()
    assert asked == [task]
