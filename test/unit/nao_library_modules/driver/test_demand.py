"""Something runs on the robot exactly while it is wanted."""

from __future__ import annotations

import fake_sound
import pytest

from nao_library_modules.driver import demand as demand_module
from nao_library_modules.driver.demand import Demand
from naoqi.errors import NaoError

LIMIT = 5.0


class Thing:
    def __init__(self):
        self.calls = []
        self.failures = 0
        self.alive = True

    def start(self):
        self.calls.append("start")
        if self.failures:
            self.failures -= 1
            raise NaoError("not yet")

    def stop(self):
        self.calls.append("stop")


@pytest.fixture
def thing():
    return Thing()


@pytest.fixture
def robot(make_call):
    return fake_sound.Robot(make_call)


@pytest.fixture
def demand(robot, thing, monkeypatch):
    monkeypatch.setattr(demand_module, "RETRY", 0.01)
    monkeypatch.setattr(demand_module, "FIRST_RETRY", 0.01)
    monkeypatch.setattr(demand_module, "LOOK_PERIOD", 0.01)
    demand = Demand(robot, "thing", thing.start, thing.stop, lambda: thing.alive)
    yield demand
    demand.close(LIMIT)


def test_it_runs_while_it_is_wanted(demand, thing, eventually):
    assert thing.calls == []
    demand.want(True)
    eventually(lambda: demand.running)
    demand.want(False)
    eventually(lambda: not demand.running)
    assert thing.calls == ["start", "stop"]


def test_it_is_tried_again_until_it_works(demand, thing, eventually):
    thing.failures = 3
    demand.want(True)
    eventually(lambda: demand.running)
    assert thing.calls == ["start"] * 4
    assert demand.problem == ""


def test_it_waits_for_the_robot_and_starts_again_after_a_loss(demand, robot, thing, eventually):
    robot.lose()
    demand.want(True)
    assert thing.calls == []
    robot.come_back()
    eventually(lambda: demand.running)
    robot.lose()
    assert not demand.running
    robot.come_back()
    eventually(lambda: thing.calls == ["start", "start"] and demand.running)


def test_nothing_is_stopped_on_a_robot_that_forgot_it(demand, robot, thing, eventually):
    demand.want(True)
    eventually(lambda: demand.running)
    robot.lose()
    demand.want(False)
    robot.come_back()
    demand.stop_now()
    assert thing.calls == ["start"]


def test_started_in_the_calling_thread_it_tells_what_is_wrong(demand, thing):
    thing.failures = 1
    with pytest.raises(NaoError, match="not yet"):
        demand.start_now()
    assert not demand.wanted and not demand.running
    demand.start_now()
    demand.start_now()
    assert demand.running and thing.calls == ["start", "start"]
    demand.stop_now()
    assert not demand.running and thing.calls[2:] == ["stop"]


def test_a_change_starts_it_anew(demand, thing, eventually):
    demand.start_now()
    demand.restart()
    eventually(lambda: thing.calls == ["start", "stop", "start"] and demand.running)


def test_one_that_is_not_alive_is_started_anew(demand, thing, eventually):
    demand.start_now()
    thing.alive = False
    eventually(lambda: thing.calls[:3] == ["start", "stop", "start"])


def test_its_owner_takes_it_along(robot, thing, eventually):
    demand = Demand(robot, "thing", thing.start, thing.stop)
    demand.want(True)
    eventually(lambda: demand.running)
    demand.close(LIMIT)
    assert thing.calls == ["start", "stop"]
    robot.come_back()
    assert thing.calls == ["start", "stop"]
