"""Waits on ROS time; simulated time is set by hand as rospy does it for each message of /clock."""

from __future__ import annotations

import threading

import pytest
import rospy
from rospy import rostime

from nao_library_modules.interrupt import Interrupt
from nao_library_modules.ros_clock import RosClock

LIMIT = 5.0


@pytest.fixture
def set_time():
    """Sets simulated time in s; wall-clock time is back afterwards."""
    rostime.set_rostime_initialized(True)

    def to(seconds):
        rostime._set_rostime(rospy.Time.from_sec(seconds))

    to(100.0)
    yield to
    rostime.switch_to_wallclock()
    rostime.set_rostime_initialized(False)


class Waiter(threading.Thread):
    """Waits in a thread of its own."""

    def __init__(self, duration, interrupt):
        super().__init__(daemon=True)
        self.duration = duration
        self.interrupt = interrupt
        self.result = None
        self.start()
        assert self.still_waits()

    def run(self):
        self.result = RosClock().wait(self.duration, self.interrupt)

    def still_waits(self):
        """Whether it waits (again) for the next message of /clock; False when it has ended."""
        while self.is_alive():
            with rostime.get_rostime_cond():
                if rostime.get_rostime_cond()._waiters:
                    return True
            self.join(0.001)
        return False

    def ended(self):
        self.join(LIMIT)
        return not self.is_alive()


def test_the_wait_ends_when_simulated_time_has_passed(set_time):
    waiter = Waiter(2.0, Interrupt())
    set_time(101.0)
    assert waiter.still_waits(), "half the time is no reason to go on"
    set_time(102.0)
    assert waiter.ended()
    assert waiter.result is True


def test_an_interrupt_ends_the_wait_while_time_stands_still(set_time):
    interrupt = Interrupt()
    waiter = Waiter(2.0, interrupt)
    interrupt.trigger()
    assert waiter.ended()
    assert waiter.result is False


def test_a_jump_back_in_time_does_not_lengthen_the_wait(set_time):
    waiter = Waiter(2.0, Interrupt())
    for moment in (101.0, 0.5):  # the simulation started again
        set_time(moment)
        assert waiter.still_waits()
    set_time(1.5)
    assert waiter.ended()
    assert waiter.result is True


def test_time_that_has_not_begun_does_not_count(set_time):
    set_time(0.0)
    waiter = Waiter(2.0, Interrupt())
    set_time(500.0)  # the first message of /clock
    assert waiter.still_waits()
    set_time(502.0)
    assert waiter.ended()


def test_now_is_simulated_time(set_time):
    set_time(123.5)
    assert RosClock().now() == pytest.approx(123.5)


def test_without_simulated_time_it_is_the_wall_clock():
    rostime.set_rostime_initialized(True)
    interrupt = Interrupt()
    clock = RosClock()
    began = clock.now()
    assert clock.wait(0.02, interrupt)
    assert clock.now() - began >= 0.015
    interrupt.trigger()
    assert not clock.wait(60.0, interrupt)
