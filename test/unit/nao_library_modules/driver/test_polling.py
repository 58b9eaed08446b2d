"""Readings at an even rate, while somebody wants them."""

from __future__ import annotations

import threading

import fake_sound
import pytest

from nao_library_modules.driver import polling as polling_module
from nao_library_modules.driver.polling import Polling
from naoqi.errors import NaoError


class HandClock:
    """Time that the test turns; waits end when it does."""

    def __init__(self):
        self.time = 100.0
        self._turned = threading.Condition()

    def now(self):
        return self.time

    def turn(self, seconds):
        with self._turned:
            self.time += seconds
            self._turned.notify_all()

    def wait(self, duration, interrupt):
        def wake():
            with self._turned:
                self._turned.notify_all()

        with interrupt.waking(wake), self._turned:
            end = self.time + duration
            self._turned.wait_for(lambda: self.time >= end - 1e-9 or interrupt.is_set())
        return not interrupt.is_set()


class Sensor:
    def __init__(self):
        self.readings = 0
        self.error = None

    def read(self):
        if self.error is not None:
            raise self.error
        self.readings += 1


@pytest.fixture
def clock():
    return HandClock()


@pytest.fixture
def sensor():
    return Sensor()


@pytest.fixture
def robot(make_call, monkeypatch):
    monkeypatch.setattr(polling_module, "RETRY", 0.01)
    return fake_sound.Robot(make_call)


@pytest.fixture
def polling(robot, clock, sensor):
    polling = Polling(robot, "sensor", 10.0, clock, sensor.read)
    yield polling
    polling.close()


def test_it_reads_at_its_rate_while_it_is_wanted(polling, clock, sensor, eventually):
    assert polling.report().message == "nobody listens"
    polling.want(True)
    eventually(lambda: sensor.readings == 1)
    for count in range(2, 6):
        clock.turn(0.1)
        eventually(lambda count=count: sensor.readings == count)
    polling.want(False)
    clock.turn(10.0)
    polling.want(True)
    eventually(lambda: sensor.readings == 6)
    assert polling.report().values["readings"] == "6"


def test_nobody_waits_for_a_clock_that_stands_still(robot, clock, sensor, eventually):
    polling = Polling(robot, "sensor", 10.0, clock, sensor.read)
    polling.want(True)
    eventually(lambda: sensor.readings == 1)
    polling.close(5.0)
    assert not polling._thread.is_alive()


def test_failures_are_told_and_it_goes_on(polling, clock, sensor, eventually):
    sensor.error = NaoError("the cable is loose")
    polling.want(True)
    eventually(lambda: polling.report().message == "the sensor cannot be read: the cable is loose")
    sensor.error = ValueError("a mistake")
    eventually(lambda: "unexpected error: ValueError" in polling.report().message)
    sensor.error = None
    eventually(lambda: polling.report().message == "read")


def test_it_waits_for_a_lost_robot(polling, robot, clock, sensor, eventually):
    robot.lose()
    polling.want(True)
    eventually(lambda: "not connected" in polling.report().message)
    assert sensor.readings == 0
    robot.come_back()
    eventually(lambda: sensor.readings == 1)
