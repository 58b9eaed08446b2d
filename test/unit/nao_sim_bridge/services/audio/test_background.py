"""Work in the background: in order, with results and errors, and time waits as long as it goes on."""

from __future__ import annotations

import threading

import pytest

from nao_sim_bridge.services.audio.background import Background
from nao_sim_bridge.sim.tasks import Task


def test_jobs_are_done_in_turn_and_hold_until_the_last_is_done(patience):
    released, may_end, done = threading.Event(), threading.Event(), []
    background = Background(lambda: None if background.holds() else released.set())

    def work(number):
        assert may_end.wait(patience)
        done.append(number)
        return number

    tasks = [background.in_turn(lambda _, number=number: work(number), "work") for number in range(5)]
    assert background.holds()
    may_end.set()
    assert [task.result(patience) for task in tasks] == list(range(5)) == done
    assert released.wait(patience)
    assert not background.holds()
    assert background.in_turn(lambda _: "again", "work").result(patience) == "again"


def test_time_waits_for_a_task_that_a_job_leads_to(patience):
    background, leads_to = Background(), Task("command", 0)
    assert background.in_turn(lambda _: leads_to, "work").result(patience) is leads_to
    assert background.holds()
    leads_to.finish()
    assert not background.holds()


def test_an_error_is_passed_on_and_ends_the_hold(patience):
    released = threading.Event()
    background = Background(released.set)

    def fail(_):
        raise ValueError("broken")

    with pytest.raises(ValueError, match="broken"):
        background.in_turn(fail, "work").result(patience)
    assert released.wait(patience)
    assert not background.holds()


def test_work_beside_the_rest_holds_nothing_and_keeps_nobody_waiting(patience):
    background, may_end = Background(), threading.Event()
    slow = background.beside(lambda _: may_end.wait(patience), "work")
    assert not background.holds()
    assert background.in_turn(lambda _: 1, "work").result(patience) == 1
    assert not slow.finished
    may_end.set()
    assert slow.result(patience) is True


@pytest.mark.parametrize("way", ["stop", "request_kill"])
def test_work_learns_that_nobody_wants_it_any_more(patience, way):
    background, begun, may_end, seen = Background(), threading.Event(), threading.Event(), []

    def work(wanted):
        seen.append(wanted())
        begun.set()
        assert may_end.wait(patience)
        seen.append(wanted())

    task = background.in_turn(work, "work")
    assert begun.wait(patience)
    (background.stop if way == "stop" else task.request_kill)()
    may_end.set()
    task.result(patience)
    background.in_turn(lambda _: None, "after it").result(patience)
    assert seen == [True, False]


@pytest.mark.parametrize("in_turn", [True, False])
def test_work_that_is_cancelled_counts_as_killed_and_only_then(patience, in_turn):
    background, may_end = Background(), threading.Event()
    way = background.in_turn if in_turn else background.beside
    task = way(lambda _: may_end.wait(patience), "work")
    task.request_kill()
    task.result(patience)
    may_end.set()
    done = way(lambda _: 1, "work")
    assert done.result(patience) == 1
    done.request_kill()
    assert task.killed and not done.killed
