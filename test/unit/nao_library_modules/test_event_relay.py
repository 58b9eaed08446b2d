"""Events of the robot's memory on their way to a sink."""

from __future__ import annotations

import pytest

from nao_library_modules.event_relay import EventRelay
from naoqi.errors import RobotError


@pytest.fixture
def heard():
    return []


@pytest.fixture
def relay(robot, heard):
    return EventRelay(lambda: robot.proxy("ALMemory"), lambda name, value: heard.append((name, value)))


def test_events_reach_the_sink_while_subscribed(robot, relay, heard):
    relay.subscribe("FrontTactilTouched")
    signal = robot.memory.signals["FrontTactilTouched"]
    signal(1.0)
    relay.unsubscribe("FrontTactilTouched")
    signal(0.0)
    assert heard == [("FrontTactilTouched", 1.0)]
    assert relay.names == []


def test_subscribing_twice_passes_events_on_once(robot, relay, heard):
    relay.subscribe("A")
    relay.subscribe("A")
    robot.memory.signals["A"](5)
    assert heard == [("A", 5)]


def test_after_a_reconnection_the_new_robot_is_subscribed(robot, relay, heard):
    relay.subscribe("A")
    robot.memory.signals.clear()  # the robot behind the new connection knows nothing
    relay.renew()
    robot.memory.signals["A"](5)
    assert heard == [("A", 5)]


def test_a_robot_that_refuses_leaves_no_subscription(robot, relay):
    def refuse(name):
        raise RobotError("ALMemory", "subscriber", f"no event {name}")

    robot.memory.subscriber = refuse
    with pytest.raises(RobotError):
        relay.subscribe("A")
    assert relay.names == []


def test_a_failing_sink_does_not_reach_the_robot(robot, caplog):
    def fail(name, value):
        raise ValueError("sink is full")

    relay = EventRelay(lambda: robot.proxy("ALMemory"), fail)
    relay.subscribe("A")
    robot.memory.signals["A"](5)
    assert "sink is full" in caplog.text


def test_close_ends_all_subscriptions(robot, relay):
    relay.subscribe("A")
    relay.subscribe("B")
    relay.close()
    assert all(not signal.links for signal in robot.memory.signals.values())
