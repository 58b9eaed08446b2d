"""Work in the background, for which time waits, and formats of the sound for modules of clients."""

from __future__ import annotations

import threading

import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.background import Background

PATIENCE = 60.0


def test_jobs_are_done_in_turn_and_hold_until_the_last_is_done():
    released, may_end, done = threading.Event(), threading.Event(), []
    background = Background(lambda: None if background.holds() else released.set())

    def work(number):
        assert may_end.wait(PATIENCE)
        done.append(number)
        return number

    tasks = [background.in_turn(lambda _, number=number: work(number), "work") for number in range(5)]
    assert background.holds()
    may_end.set()
    assert [task.result(PATIENCE) for task in tasks] == list(range(5)) == done
    assert released.wait(PATIENCE) and not background.holds()
    with pytest.raises(ZeroDivisionError):
        background.in_turn(lambda _: 1 / 0, "work").result(PATIENCE)
    leads_to = Task("command", 0)
    assert background.in_turn(lambda _: leads_to, "work").result(PATIENCE) is leads_to
    assert background.holds()  # for what the job leads to
    leads_to.finish()
    assert not background.holds()


def test_with_several_threads_work_that_is_slow_keeps_nobody_waiting():
    background, may_end = Background(threads=2), threading.Event()
    slow = background.in_turn(lambda _: may_end.wait(PATIENCE), "work")
    assert background.in_turn(lambda _: 1, "work").result(PATIENCE) == 1
    assert not slow.finished
    may_end.set()
    assert slow.result(PATIENCE) is True


@pytest.mark.parametrize("way", ["stop", "request_kill"])
def test_work_learns_that_nobody_wants_it_any_more(way):
    background, begun, may_end, seen = Background(), threading.Event(), threading.Event(), []

    def work(wanted):
        seen.append(wanted())
        begun.set()
        assert may_end.wait(PATIENCE)
        seen.append(wanted())

    task = background.in_turn(work, "work")
    assert begun.wait(PATIENCE)
    (background.stop if way == "stop" else task.request_kill)()
    may_end.set()
    task.result(PATIENCE)
    background.in_turn(lambda _: None, "after it").result(PATIENCE)
    assert seen == [True, False] and (way == "stop" or task.killed)
    done = background.in_turn(lambda _: 1, "work")
    assert done.result(PATIENCE) == 1
    done.request_kill()
    assert not done.killed


# --- modules that hear ------------------------------------------------------------------------------------------------


def test_no_more_wait_for_their_turn_than_may():
    background, may_end = Background(most=2), threading.Event()
    tasks = [background.in_turn(lambda _: may_end.wait(PATIENCE), "look") for _ in range(2)]
    with pytest.raises(BadValue, match="calls of look that have not ended is 3, allowed is at most 2"):
        background.in_turn(lambda _: None, "look")
    may_end.set()
    assert [task.result(PATIENCE) for task in tasks] == [True, True]


def test_what_is_asked_for_after_the_end_is_not_wanted():
    background = Background()
    background.close()
    assert background.in_turn(lambda wanted: wanted(), "work").result(PATIENCE) is False
