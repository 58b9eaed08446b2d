"""How often something comes, and what is told when that is not as often as it should; the clock is the test's."""

from __future__ import annotations

import logging
import threading
from types import SimpleNamespace

import pytest

from nao_library_modules.core.health import Level
from nao_library_modules.driver.base import polling
from nao_library_modules.driver.base.polling import KEPT_FOR, Polling, RateMeter

ASKED = 30.0
HANGS = 60.0
"""s of wall time after which a reading hangs."""


class Stream:
    """Things that come at rates of a clock which the test sets."""

    def __init__(self):
        self.time = 50.0
        self.meter = RateMeter("camera top", "pictures")

    def come(self, rate, seconds):
        for _ in range(round(seconds * rate)):
            self.time += 1.0 / rate
            self.meter.note(self.time, ASKED)


@pytest.fixture
def stream(caplog):
    caplog.set_level(logging.INFO)
    return Stream()


def test_the_rate_is_that_of_the_last_seconds():
    meter = RateMeter("camera top", "pictures")
    for number in range(100):
        meter.note(number / 30.0, 30.0)
        assert (meter.rate is None) == (number < 30)
    for number in range(1, 61):
        meter.note(99 / 30.0 + number / 15.0, 15.0)
    assert meter.rate == pytest.approx(15.0, abs=0.01)
    assert (meter.count, meter.missed) == (160, 0)
    for times, missed in (((0.0, 0.1, 0.4, 0.5), 2), ((50.0, 50.1, 1.0, 1.1), 0)):  # set back, a clock misses none
        meter = RateMeter("camera top", "pictures")
        for time in times:
            meter.note(time, 10.0)
        assert meter.missed == missed


def test_a_rate_that_is_not_kept_is_told_once_and_once_when_it_is_kept_again(stream, caplog):
    stream.come(30.0, 10.0)
    assert not caplog.messages and not stream.meter.problem(ASKED)
    stream.come(12.0, 60.0)
    told = "only 12.0 of 30 pictures a second"
    assert caplog.messages == [f"camera top: {told}: what is late is left out"]
    assert caplog.records[0].levelno == logging.WARNING and stream.meter.problem(ASKED) == told
    assert stream.meter.values(ASKED) == {"rate asked for (1/s)": "30", "rate reached (1/s)": "12.0"}
    stream.come(30.0, 60.0)
    assert caplog.messages[1:] == ["camera top: 30.0 of 30 pictures a second come again"]
    assert caplog.records[1].levelno == logging.INFO and not stream.meter.problem(ASKED)


def test_a_rate_that_goes_up_and_down_is_told_once(stream, caplog):
    for _ in range(10):
        stream.come(12.0, 10.0)
        stream.come(30.0, KEPT_FOR - 3.0)
    assert len(caplog.messages) == 1 and stream.meter.problem(ASKED)


def test_a_rate_between_the_bounds_changes_nothing(stream, caplog):
    stream.come(0.85 * ASKED, 60.0)
    assert not caplog.messages
    stream.come(0.5 * ASKED, 10.0)
    stream.come(0.85 * ASKED, 60.0)
    assert len(caplog.messages) == 1 and stream.meter.problem(ASKED)


def test_a_pause_of_a_moment_is_not_told(stream, caplog):
    for pause in (0.7, 1.5, 20.0):
        stream.come(30.0, 10.0)
        stream.time += pause
    stream.come(30.0, 10.0)
    assert not caplog.messages and stream.meter.missed > 600


def test_another_stream_begins_as_if_nothing_had_been(stream, caplog):
    stream.come(12.0, 10.0)
    stream.meter.restart()
    assert stream.meter.rate is None and not stream.meter.problem(ASKED)
    stream.time -= 40.0  # the clock was set back
    stream.come(30.0, 60.0)
    assert len(caplog.messages) == 1


class ScriptedClock:
    """Time that passes while somebody waits for it, and while the robot answers."""

    def __init__(self):
        self.time = 50.0

    def now(self):
        return self.time

    def wait(self, seconds, interrupt):
        self.time += seconds
        return not interrupt.is_set()


def test_readings_that_take_too_long_are_told_in_the_log_and_in_the_report(monkeypatch, caplog):
    caplog.set_level(logging.INFO)
    monkeypatch.setattr(polling, "FASTEST", 0.0)
    clock, takes = ScriptedClock(), [0.0]
    begun, may_go_on = threading.Semaphore(0), threading.Semaphore(0)

    def read():
        begun.release()
        may_go_on.acquire()
        clock.time += takes[0]

    robot = SimpleNamespace(connection=SimpleNamespace(state="connected", wait_connected=lambda limit: True))
    joints = Polling(robot, "joints", 50.0, clock, read)

    def after(count, seconds):
        """The report after so many more readings that take as long each."""
        takes[0] = seconds
        may_go_on.release(count)
        assert all(begun.acquire(timeout=HANGS) for _ in range(count))  # the one after the last waits
        return joints.report()

    try:
        joints.want(True)
        assert begun.acquire(timeout=HANGS)
        report = after(200, 0.005)
        assert (report.level, report.message) == (Level.OK, "read") and not caplog.messages
        report = after(400, 0.05)
        assert report.level == Level.WARN and report.message.startswith("only ")
        assert report.values["rate asked for (1/s)"] == "50" and float(report.values["rate reached (1/s)"]) < 25.0
        assert [message.split(":")[0] for message in caplog.messages] == ["joints"]
        report = after(1000, 0.005)
        assert (report.level, report.message) == (Level.OK, "read")
        assert len(caplog.messages) == 2 and caplog.messages[1].endswith("of 50 readings a second come again")
    finally:
        joints.want(False)
        may_go_on.release(10)
        joints.close()
