"""The flag that ends waiting."""

from __future__ import annotations

import threading
import weakref

import pytest

from nao_library_modules.clock import WallClock
from nao_library_modules.errors import Preempted, RobotLost
from nao_library_modules.interrupt import Interrupt


def test_check_passes_until_triggered():
    interrupt = Interrupt()
    interrupt.check()
    interrupt.trigger()
    with pytest.raises(Preempted):
        interrupt.check()


def test_the_first_reason_counts():
    interrupt = Interrupt()
    interrupt.trigger(RobotLost("10.0.0.7:9559", "no answer"))
    interrupt.trigger()
    with pytest.raises(RobotLost, match="10.0.0.7:9559"):
        interrupt.check()


def test_clear_forgets_the_trigger_and_its_reason():
    interrupt = Interrupt()
    interrupt.trigger(RobotLost("10.0.0.7:9559", "no answer"))
    interrupt.clear()
    interrupt.check()
    interrupt.trigger()
    with pytest.raises(Preempted):
        interrupt.check()


def test_stop_outlives_clear():
    interrupt = Interrupt()
    interrupt.stop()
    interrupt.clear()
    with pytest.raises(Preempted):
        interrupt.check()


def test_a_wait_on_the_clock_ends_at_the_trigger_from_another_thread():
    interrupt = Interrupt()
    clock = WallClock()
    began = clock.now()
    threading.Timer(0.05, interrupt.trigger).start()
    assert not clock.wait(60.0, interrupt)
    assert clock.now() - began < 30.0


def test_an_undisturbed_wait_takes_its_time():
    clock = WallClock()
    began = clock.now()
    assert clock.wait(0.05, Interrupt())
    assert clock.now() - began >= 0.05


def test_wakers_are_called_once_each_and_not_after_their_block():
    interrupt = Interrupt()
    woken = []
    with interrupt.waking(lambda: woken.append("inner")):
        interrupt.trigger()
    assert woken == ["inner"]
    interrupt.clear()
    interrupt.trigger()
    assert woken == ["inner"]


def test_a_waker_that_comes_late_is_called_at_once():
    interrupt = Interrupt()
    interrupt.trigger()
    woken = []
    with interrupt.waking(lambda: woken.append(True)):
        assert woken == [True]


def test_a_waker_may_use_the_interrupt_itself():
    """Wakers run without the lock; with it this would be a deadlock."""
    interrupt = Interrupt()
    seen = []
    with interrupt.waking(lambda: seen.append(interrupt.is_set())):
        thread = threading.Thread(target=interrupt.trigger, daemon=True)
        thread.start()
        thread.join(5.0)
    assert seen == [True]


class Goal:
    """What somebody works on who is interrupted."""


def test_what_was_interrupted_is_not_kept(no_ring_collector):
    """The error keeps the frames that it went through: none of them may keep it."""
    goals = []

    def work():
        goal = Goal()
        goals.append(weakref.ref(goal))
        interrupt.check()

    interrupt = Interrupt()
    interrupt.trigger()
    with pytest.raises(Preempted):
        work()
    interrupt.clear()
    assert goals[0]() is None
