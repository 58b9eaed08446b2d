"""A connection notices its loss in time, says so, and comes back by itself."""

from __future__ import annotations

import hashlib
import socket
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
import qi

import naoqi
from naoqi import directory, errors
from naoqi.native_threads import wait_until_idle
from naoqi.state import Timing

SOON = 10.0
"""More than any machine needs; the promise itself is of the settings, see Timing."""


@pytest.fixture
def robot(fragile_robot):
    return fragile_robot


@pytest.fixture
def pool():
    with ThreadPoolExecutor() as pool:
        yield pool


def test_a_connection_knows_how_it_is(robot, eventually):
    connection = robot.proxy().connection
    eventually(lambda: connection.latency is not None, "the first heartbeat is answered")
    assert connection.state == "connected"
    assert 0.0 < connection.latency < SOON
    assert (connection.generation, connection.last_error) == (1, "")


@pytest.mark.parametrize("harm, repair", [("kill", "start"), ("silence", "speak")])
def test_a_loss_fails_the_call_under_way_in_time_and_the_same_proxy_works_again(
    robot, proxy, pool, begun, states, harm, repair
):
    method, followed = proxy.add, states(proxy.connection)
    call = pool.submit(proxy.begin)
    begun()
    start = time.monotonic()
    getattr(robot, harm)()
    error = call.exception(SOON)
    assert type(error) is errors.ConnectionLost and error.call == "ALTest.begin"
    assert time.monotonic() - start < SOON
    followed.wait_for("lost")
    assert ("heartbeat" in proxy.connection.last_error) is (harm == "silence")
    with pytest.raises(errors.RobotUnreachable, match="lost .* s ago .*reconnecting"):
        proxy.add(1, 2)
    getattr(robot, repair)()
    followed.wait_for("lost", "connected")
    assert proxy.add(1, 2) == 3 and method(3, 4) == 7
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


def test_a_module_may_appear_a_moment_after_the_robot(robot, states, pool):
    robot.kill()
    connection = naoqi.connection(*robot.address, wait=False)
    followed = states(connection)
    robot.start()
    followed.wait_for("connected")
    answer = pool.submit(lambda: robot.proxy("Visitor").add(1, 1))
    robot.proxy("Switch").arrive("Visitor")
    assert answer.result(SOON) == 2


def test_threads_that_want_the_same_module_look_it_up_once(robot, pool, monkeypatch):
    connection, find, asked = naoqi.connection(*robot.address), directory.find_module, []
    both = threading.Event()

    def found(*arguments):
        asked.append(arguments)
        if len(asked) == 2:
            both.set()
        both.wait(0.1)  # for the other one, which must not come
        return find(*arguments)

    monkeypatch.setattr(directory, "find_module", found)
    first, second = pool.map(connection.service, ("ALTest", "ALTest"))
    assert first is second and len(asked) == 1


def test_a_closed_connection_refuses_and_a_new_one_can_be_had(robot, states):
    proxy = robot.proxy()
    followed = states(proxy.connection)
    proxy.connection.close()
    followed.wait_for("closed")
    with pytest.raises(errors.RobotUnreachable, match="this program has closed"):
        proxy.add(1, 2)
    assert proxy.connection.wait_connected() is False
    assert robot.proxy().add(1, 2) == 3


def test_the_end_waits_for_a_thread_of_libqi_that_is_still_at_work():
    begun, let_go, much = threading.Event(), threading.Event(), bytes(100_000_000)

    def work():
        threading.current_thread()  # as logging does: Python has the thread in its list from then on
        while not let_go.is_set():
            hashlib.sha256(much)
            begun.set()

    working = qi.runAsync(work)
    assert begun.wait(SOON) and not wait_until_idle(0.05)
    let_go.set()
    assert wait_until_idle(SOON) and working.isFinished()


def test_a_silent_robot_is_given_up_within_two_seconds():
    timing = Timing()
    assert timing.heartbeat_period + timing.heartbeat_limit < 2.0
