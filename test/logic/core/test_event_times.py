"""Times of events that come late, in any order, and after others were raised."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.core.robot_events import EventTimes, RobotClock
from naoqi.errors import RobotError

TOUCHED = "FrontTactilTouched"
LATE = 14.0
"""ROS time, s, at which all arrives in these cases: long after it was raised."""


class Memory:
    """A robot whose memory knows the last values of one event; its clock is ROS time."""

    def __init__(self, tells=True, most=32):
        self.time, self.history, self.tells, self.most = 10.0, [], tells, most
        self.connection = SimpleNamespace(generation=1)
        clock = RobotClock(self, SimpleNamespace(now=lambda: LATE, simulated=True))
        self.times = EventTimes(self, clock, self.call)

    def proxy(self, name):
        return self

    def raises(self, value, time):
        self.time = time
        self.history = [*self.history, [value, int(time), round(time % 1 * 1e6)]][-self.most :]

    def call(self, proxy, method, key, *value):
        if method == "getEventHistory":
            if not self.tells:
                raise RobotError("ALMemory", method, "no such thing")
            return self.history
        if key == TOUCHED:
            return self.history[-1]
        return [0.0, int(self.time), round(self.time % 1 * 1e6)]

    def come(self, *values):
        """What is told of the times of events that come in this order."""
        return [self.times.time_of(event) for event in [self.times.arrived(TOUCHED, each, LATE) for each in values]]


@pytest.fixture
def memory():
    return Memory()


def touched(memory, *presses):
    for number, time in enumerate(presses):
        memory.raises(1.0 - number % 2, time)


@pytest.mark.parametrize(
    "values, times", [((1.0, 0.0, 1.0, 0.0), (10.1, 10.2, 10.4, 10.7)), ((0.0, 1.0), (10.2, 10.1))]
)
def test_an_event_has_its_own_time_whatever_was_raised_until_it_came(memory, values, times):
    memory.times.begin(TOUCHED)
    touched(memory, 10.1, 10.2, 10.4, 10.7)
    assert memory.come(*values) == pytest.approx(times)


def test_what_was_raised_before_the_subscription_does_not_count(memory):
    touched(memory, 10.1, 10.2)
    memory.times.begin(TOUCHED)
    touched(memory, 10.4, 10.7)
    assert memory.come(1.0, 0.0) == pytest.approx([10.4, 10.7])


def test_an_event_between_the_subscription_and_its_first_look_takes_the_time_of_no_other(memory):
    touched(memory, 10.1)
    memory.times.begin(TOUCHED)  # subscribed before
    assert memory.come(1.0) == pytest.approx([10.1])
    memory.raises(0.0, 10.2)
    touched(memory, 10.4, 10.5)
    assert memory.come(1.0) == pytest.approx([10.4])


def test_events_are_told_apart_for_as_long_as_they_come(memory):
    memory.times.begin(TOUCHED)
    for number in range(100):
        begin = 10.0 + 0.03 * number
        touched(memory, begin + 0.01, begin + 0.02)
        assert memory.come(0.0, 1.0) == pytest.approx([begin + 0.02, begin + 0.01])


def test_an_event_may_be_asked_for_later_and_twice(memory):
    memory.times.begin(TOUCHED)
    touched(memory, 10.1, 10.2, 10.3)
    first, second = (memory.times.arrived(TOUCHED, 1.0, LATE) for _ in range(2))
    assert [memory.times.time_of(each) for each in (second, first, first)] == pytest.approx([10.3, 10.1, 10.1])


def test_values_that_are_lists_have_the_last_time_of_theirs(memory):
    memory.times.begin(TOUCHED)
    for value, time in (([["ball", 1]], 10.1), ([["ball", 2]], 10.2), ([], 10.3)):
        memory.raises(value, time)
    assert memory.come([["ball", 1]]) == pytest.approx([10.1])


def test_without_a_history_an_event_that_was_raised_again_has_the_time_of_its_arrival():
    memory = Memory(tells=False)
    memory.times.begin(TOUCHED)
    touched(memory, 10.1, 10.2)
    assert memory.come(1.0, 0.0) == pytest.approx([LATE, 10.2])
