"""Tasks: one end, whoever asks for it, and callbacks that hear of it once; commands at moments."""

from __future__ import annotations

import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.base.timed_commands import AT_ONCE, merged, polyline

OLD, NEW = ((0.1, 100), (0.2, 200), (0.3, 300)), ((0.5, 250), (0.6, 200))


@pytest.fixture
def task():
    return Task("glide", 7)


def test_a_task_ends_once_and_callbacks_hear_of_it_once_early_or_late(task):
    heard = []
    task.add_done_callback(lambda done: heard.append(("early", done.value)))
    task.add_done_callback(lambda done: done.kill())
    assert not task.finished and task.value is None
    with pytest.raises(TimeoutError, match=r"task glide \(7\) has not ended within 0 s"):
        task.result(timeout=0)
    assert task.finish("first") and not task.finish("second") and not task.kill()
    task.add_done_callback(lambda done: heard.append(("late", done.value)))
    assert task.finished and not task.killed and task.result(timeout=0) == "first" == task.value
    assert heard == [("early", "first"), ("late", "first")]


def test_a_kill_drops_the_work_before_anybody_hears_of_the_end():
    order = []
    task = Task("glide", 1, on_kill=lambda done: order.append(("dropped", done.finished)))
    task.add_done_callback(lambda done: order.append(("heard", done.killed)))
    after = task.then(bool)
    assert task.kill() and order == [("dropped", False), ("heard", True)]
    assert task.killed and task.error is None
    assert after.killed and after.result(timeout=0) is False


def test_then_passes_results_and_errors_on(task):
    after = task.then(lambda value: value * 2)
    assert not after.finished
    task.finish(21)
    assert after.result(timeout=0) == 42
    failed = Task("glide", 8)
    after = failed.then(lambda value: value * 2)
    failed.finish(error=BadValue("speed", -1, "above 0"))
    assert isinstance(failed.error, BadValue) and failed.value is None
    for one in (failed, after):
        with pytest.raises(BadValue, match="speed is -1"):
            one.result(timeout=0)


def test_a_requested_kill_goes_to_who_runs_the_simulation_also_from_the_end_of_a_chain():
    ids, other, asked = TaskIds(), TaskIds(), []
    task = ids.make("a")
    assert [task.task_id, ids.make("b").task_id, other.make("c").task_id] == [1, 2, 1]
    task.request_kill()
    ids.ask = asked.append
    task.request_kill()
    task.then(str).request_kill()
    assert asked == [task, task] and not task.finished


@pytest.mark.parametrize(
    "new, update, result",
    [
        (NEW, "Merge", ((0.1, 100), (0.6, 200), (0.5, 250), (0.3, 300))),
        (NEW, "ClearAll", ((0.6, 200), (0.5, 250))),
        (NEW, "ClearAfter", ((0.1, 100), (0.6, 200), (0.5, 250))),
        (NEW, "ClearBefore", ((0.6, 200), (0.5, 250), (0.3, 300))),
    ],
)
def test_how_new_commands_join_old_ones(new, update, result):
    assert merged(OLD, new, update) == result
    with pytest.raises(BadValue, match="update type is 'Clear', allowed is Merge, ClearAll, ClearAfter, ClearBefore"):
        merged(OLD, new, "Clear")


def test_the_way_of_commands_is_straight_between_moments_and_what_is_past_is_done_at_once():
    way = polyline(((0.5, 3000), (-0.5, 4000)), now=2000, start=0.0)
    found = [way.value(elapsed) for elapsed in (-1.0, 0.0, 0.5, 1.0, 1.5, 9.0)]
    assert found == pytest.approx([0.0, 0.0, 0.25, 0.5, 0.0, -0.5]) and way.duration == 2.0
    way = polyline(((0.1, 100), (0.4, 900), (0.8, 2000)), now=1000, start=0.0)
    assert (way.value(AT_ONCE), way.value(1.0)) == (0.4, 0.8)
    assert polyline(((0.7, 10),), now=1000, start=0.0).value(AT_ONCE) == 0.7
    assert polyline((), now=0, start=0.0) is None
