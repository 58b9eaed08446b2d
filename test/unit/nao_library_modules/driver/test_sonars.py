"""Distances while somebody wants to know them."""

from __future__ import annotations

import math

import fake_memory
import fake_sound
import pytest

from nao_library_modules.body_devices import SONARS as KEYS
from nao_library_modules.clock import WallClock
from nao_library_modules.driver import demand, polling
from nao_library_modules.driver.sonars import Sonars, range_of


class Sonar:
    def __init__(self):
        self.subscribers = []

    def subscribe(self, name):
        self.subscribers.append(name)

    def unsubscribe(self, name):
        self.subscribers.remove(name)


@pytest.fixture
def robot(make_call, monkeypatch):
    for module in (demand, polling):
        monkeypatch.setattr(module, "RETRY", 0.01)
    monkeypatch.setattr(demand, "FIRST_RETRY", 0.01)
    memory = fake_memory.Memory({KEYS["left"]: 0.8, KEYS["right"]: 5.0})
    return fake_sound.Robot(make_call, ALMemory=memory, ALSonar=Sonar())


@pytest.fixture
def told():
    return []


@pytest.fixture
def sonars(robot, told):
    sonars = Sonars(robot, "ros_nao_sonar", 100.0, WallClock(), told.append)
    yield sonars
    sonars.close()


@pytest.mark.parametrize(
    "value, range_",
    [(0.25, 0.25), (1.7, 1.7), (2.54, 2.54), (2.55, math.inf), (5.0, math.inf), (0.1, -math.inf), (1, 1.0)],
)
def test_distances_follow_rep_117(value, range_):
    assert range_of(value) == range_


@pytest.mark.parametrize("value", [0.0, -1.0, None, "far", True, math.nan])
def test_a_sensor_that_failed_has_no_distance(value):
    assert math.isnan(range_of(value))


def test_the_robot_measures_only_while_somebody_listens(sonars, robot, told, eventually):
    sonar = robot.services["ALSonar"]
    assert sonar.subscribers == [] and sonars.report().message == "nobody listens"
    sonars.want(True)
    eventually(lambda: len(told) > 2)
    assert sonar.subscribers == ["ros_nao_sonar"] and told[0] == {"left": 0.8, "right": math.inf}
    sonars.want(False)
    eventually(lambda: sonar.subscribers == [])


def test_it_measures_again_after_a_loss(sonars, robot, told, eventually):
    sonar = robot.services["ALSonar"]
    sonars.want(True)
    eventually(lambda: told)
    robot.lose()
    sonar.subscribers.clear()
    eventually(lambda: "not connected" in sonars.report().message)
    told.clear()
    robot.come_back()
    eventually(lambda: told and sonar.subscribers == ["ros_nao_sonar"])


def test_a_robot_without_sonars_is_told_and_nothing_old_is_published(make_call, robot, told, eventually):
    del robot.services["ALSonar"]
    sonars = Sonars(robot, "ros_nao_sonar", 100.0, WallClock(), told.append)
    sonars.want(True)
    eventually(lambda: "no module 'ALSonar'" in sonars.report().message)
    assert told == []
    sonars.close()
