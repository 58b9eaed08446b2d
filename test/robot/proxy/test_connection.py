"""A connection notices its loss in time, says so, and comes back by itself."""

from __future__ import annotations

import socket
import time

import pytest

import naoqi
from naoqi import errors

SOON = 10.0
"""More than any machine needs; the promise itself is of the settings, see Timing."""


@pytest.fixture
def robot(fragile_robot):
    return fragile_robot


@pytest.fixture
def call_under_way(proxy, in_thread, begun):
    """A call that waits for its answer in another thread; has arrived at the robot."""
    finish = in_thread(proxy.begin)
    begun()
    return finish


def test_a_connection_knows_how_it_is(robot, eventually):
    connection = robot.proxy().connection
    eventually(lambda: connection.latency is not None, "the first heartbeat is answered")
    assert connection.state == "connected"
    assert 0.0 < connection.latency < SOON
    assert (connection.generation, connection.last_error) == (1, "")


def test_a_killed_robot_fails_the_calls_under_way_at_once(robot, proxy, call_under_way):
    task = proxy.post.begin()
    start = time.monotonic()
    robot.kill()
    outcome = call_under_way()
    with pytest.raises(errors.NaoError):
        proxy.wait(task, 0)
    assert type(outcome["error"]) is errors.ConnectionLost
    assert outcome["error"].call == "ALTest.begin"
    assert outcome["ended"] - start < SOON


def test_a_silent_robot_fails_the_call_under_way_by_its_heartbeat(robot, call_under_way):
    robot.silence()
    start = time.monotonic()
    outcome = call_under_way()
    assert type(outcome["error"]) is errors.ConnectionLost
    assert outcome["ended"] - start < SOON
    assert "heartbeat" in naoqi.connection(*robot.address, wait=False).last_error
    robot.speak()


@pytest.mark.parametrize("harm, repair", [("kill", "start"), ("silence", "speak")])
def test_the_same_proxy_works_again_when_the_robot_is_back(robot, states, harm, repair):
    proxy = robot.proxy()
    method = proxy.add
    followed = states(proxy.connection)
    getattr(robot, harm)()
    followed.wait_for("lost")
    with pytest.raises(errors.RobotUnreachable, match="lost .* s ago .*reconnecting"):
        proxy.add(1, 2)
    getattr(robot, repair)()
    followed.wait_for("lost", "connected")
    assert proxy.add(1, 2) == 3
    assert method(3, 4) == 7
    assert proxy.connection.generation == 2


def test_a_robot_that_is_not_there_is_reported_at_once(robot):
    robot.kill()
    start = time.monotonic()
    with pytest.raises(errors.RobotUnreachable, match="refused.*Check") as caught:
        robot.proxy()
    assert time.monotonic() - start < SOON
    assert (caught.value.host, caught.value.port) == robot.address


def test_a_port_that_accepts_and_says_nothing_is_reported_in_time():
    with socket.create_server(("127.0.0.1", 0)) as mute:
        start = time.monotonic()
        with pytest.raises(errors.RobotUnreachable, match="no answer"):
            naoqi.ALProxy("ALTest", *mute.getsockname(), connect_timeout=0.3)
        assert time.monotonic() - start < SOON


def test_a_lazy_proxy_may_be_there_before_the_robot(robot):
    robot.kill()
    proxy = robot.proxy(lazy=True)
    method = proxy.add
    with pytest.raises(errors.RobotUnreachable, match="not reached for"):
        method(1, 2)
    robot.start()
    assert proxy.connection.wait_connected(10.0)
    assert method(1, 2) == 3
    assert proxy.add(2, 2) == 4


def test_a_module_may_appear_a_moment_after_the_robot(robot, states, in_thread):
    robot.kill()
    connection = naoqi.connection(*robot.address, wait=False)
    followed = states(connection)
    robot.start()
    followed.wait_for("connected")
    finish = in_thread(lambda: robot.proxy("Visitor").add(1, 1))
    robot.proxy("Switch").arrive("Visitor")
    assert finish().get("value") == 2


def test_a_closed_connection_refuses_and_a_new_one_can_be_had(robot, states):
    proxy = robot.proxy()
    followed = states(proxy.connection)
    proxy.connection.close()
    followed.wait_for("closed")
    with pytest.raises(errors.RobotUnreachable, match="this program has closed"):
        proxy.add(1, 2)
    assert proxy.connection.wait_connected() is False
    assert robot.proxy().add(1, 2) == 3
