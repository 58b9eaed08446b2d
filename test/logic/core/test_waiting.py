"""The flag that ends waiting, and waits on wall-clock and ROS time; rospy's time is set by hand."""

from __future__ import annotations

import threading

import pytest
import rospy
from rospy import rostime

from nao_library_modules.core.errors import Preempted, RobotLost
from nao_library_modules.core.waiting import CancellationToken, WallClock
from nao_library_modules.ros.time_and_frames import RosClock

LIMIT = 60.0
LOST = "10.0.0.7:9559", "no answer"


@pytest.fixture
def interrupt():
    return CancellationToken()


def test_the_first_reason_counts_until_it_is_cleared_and_stop_outlives_that(interrupt):
    interrupt.check()
    interrupt.trigger(RobotLost(*LOST))
    interrupt.trigger()
    with pytest.raises(RobotLost, match="10.0.0.7:9559"):
        interrupt.check()
    interrupt.clear()
    interrupt.check()
    interrupt.stop()
    interrupt.clear()
    with pytest.raises(Preempted):
        interrupt.check()


# Clocks


@pytest.fixture
def set_time(monkeypatch):
    """Sets simulated time in s, as rospy does it for each message of /clock.

    Until then ROS time is the wall clock's, even where a node of this process has heard a /clock before.
    """
    monkeypatch.setattr(rostime, "_rostime_initialized", True)
    monkeypatch.setattr(rostime, "_rostime_current", None)
    return lambda seconds: rostime._set_rostime(rospy.Time.from_sec(seconds))


@pytest.fixture(params=[WallClock, RosClock])
def wall_clock(request, set_time):
    return request.param()


def test_a_wait_takes_its_time_and_ends_at_the_trigger_from_another_thread(wall_clock, interrupt):
    began = wall_clock.now()
    assert wall_clock.wait(0.05, interrupt) and wall_clock.now() - began >= 0.045
    threading.Timer(0.05, interrupt.trigger).start()
    assert not wall_clock.wait(60.0, interrupt) and wall_clock.now() - began < 30.0


class Waiter(threading.Thread):
    """Waits for 2 s in a thread of its own."""

    def __init__(self, interrupt):
        super().__init__(daemon=True)
        self.interrupt, self.result = interrupt, None
        self.start()
        assert self.still_waits()

    def run(self):
        self.result = RosClock().wait(2.0, self.interrupt)

    def still_waits(self):
        """Whether it waits (again) for the next message of /clock; False when it has ended."""
        while self.is_alive():
            with rostime.get_rostime_cond():
                if rostime.get_rostime_cond()._waiters:
                    return True
            self.join(0.001)
        return False

    def end(self):
        self.join(LIMIT)
        assert not self.is_alive()
        return self.result


@pytest.mark.parametrize(
    "moments, last",
    [
        ((100.0, 101.0), 102.0),
        ((100.0, 101.0, 0.5), 1.5),  # the simulation started again: a jump back does not lengthen the wait
        ((0.0, 500.0), 502.0),  # time that has not begun does not count
    ],
)
def test_a_wait_ends_when_simulated_time_has_passed(set_time, interrupt, moments, last):
    set_time(moments[0])
    waiter = Waiter(interrupt)
    for moment in moments[1:]:
        set_time(moment)
        assert waiter.still_waits()
    set_time(last)
    assert waiter.end() is True and RosClock().now() == pytest.approx(last)


def test_an_interrupt_ends_the_wait_while_time_stands_still(set_time, interrupt):
    set_time(100.0)
    waiter = Waiter(interrupt)
    interrupt.trigger()
    assert waiter.end() is False


def test_time_starts_with_the_first_message_of_the_clock(set_time):
    set_time(0.0)
    started = threading.Thread(target=RosClock.wait_for_start, daemon=True)
    started.start()
    started.join(0.05)
    assert started.is_alive()
    set_time(500.0)
    started.join(LIMIT)
    assert not started.is_alive()
