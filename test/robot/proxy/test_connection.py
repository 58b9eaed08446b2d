"""A connection notices its loss in time, says so, and comes back by itself."""

from __future__ import annotations

import hashlib
import signal
import socket
import subprocess
import sys
import threading
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import asdict

import pytest
import qi
from waits import hold

import naoqi
from naoqi import errors, robot_connection
from naoqi.limits import SERVER_PATIENCE, Timing
from naoqi.session import wait_until_idle

SILENT, SPEAKING = ("connected", True), ("connected", False)
HASTY = Timing(heartbeat_period=0.1, silence=0.2, patience=0.6)
"""A connection that does not wait long."""
SOON = 60.0
"""More than any machine needs; the promise itself is of the settings, see Timing."""


class Adder:
    """A module of a robot."""

    def add(self, first, second):
        return first + second

    def ping(self):
        return True


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
    proxy.connection.timing = HASTY
    method, followed = proxy.add, states(proxy.connection)
    call = pool.submit(proxy.begin)
    begun()
    getattr(robot, harm)()
    error = call.exception(SOON)
    assert type(error) is errors.ConnectionLost and error.call == "ALTest.begin"
    followed.wait_for("lost")
    causes = {"kill": ["closed by the robot", "connection refused"], "silence": ["silent for 0.6 s"]}
    assert proxy.connection.last_error in causes[harm]  # "refused" when it was tried again already
    assert proxy.connection.last_error in str(error) or harm == "kill"
    with pytest.raises(errors.RobotUnreachable, match="lost .* s ago .*reconnecting"):
        proxy.add(1, 2)
    getattr(robot, repair)()
    followed.wait_for("lost", "connected")
    assert proxy.add(1, 2) == 3 and method(3, 4) == 7
    assert proxy.connection.generation == 2


def test_a_robot_that_is_not_there_is_reported_at_once(robot):
    robot.kill()
    with pytest.raises(errors.RobotUnreachable, match="refused.*Check") as caught:
        robot.proxy()
    assert (caught.value.host, caught.value.port) == robot.address


def test_a_port_that_accepts_and_says_nothing_is_reported_in_time():
    with socket.create_server(("127.0.0.1", 0)) as mute:
        with pytest.raises(errors.RobotUnreachable, match="no answer"):
            naoqi.ALProxy("ALTest", *mute.getsockname(), connect_timeout=0.3)


def test_a_lazy_proxy_may_be_there_before_the_robot(robot):
    robot.kill()
    proxy = robot.proxy(lazy=True)
    method = proxy.add
    with pytest.raises(errors.RobotUnreachable, match="not reached for"):
        method(1, 2)
    robot.start()
    assert proxy.connection.wait_connected(60.0)
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


@pytest.fixture
def missed(monkeypatch):
    """Set when a module was looked for in vain; only a robot that is starting is asked again."""
    monkeypatch.setattr(robot_connection, "START_LIMIT", 0.0)
    find_names, asked = robot_connection.module_names, threading.Event()
    monkeypatch.setattr(robot_connection, "module_names", lambda *where: (asked.set(), find_names(*where))[1])
    return asked


def test_a_module_that_was_used_is_waited_for_when_the_robot_comes_back(robot, states, pool, missed):
    robot.proxy("Switch").arrive("Visitor")
    visitor = robot.proxy("Visitor")
    assert visitor.add(1, 1) == 2
    followed = states(visitor.connection)
    robot.kill()
    robot.start()
    followed.wait_for("lost", "connected")
    missed.clear()
    answer = pool.submit(lambda: visitor.add(2, 2))
    assert missed.wait(SOON)
    robot.proxy("Switch").arrive("Visitor")
    assert answer.result(SOON) == 4


def test_a_robot_without_any_module_is_still_starting(pool, missed):
    session = qi.Session()
    session.listenStandalone("tcp://127.0.0.1:0")
    port = int(session.endpoints()[0].rpartition(":")[2])
    try:
        answer = pool.submit(lambda: naoqi.ALProxy("ALTest", "127.0.0.1", port).add(1, 1))
        assert missed.wait(SOON)
        session.registerService("ALTest", Adder())
        assert answer.result(SOON) == 2
    finally:
        naoqi.connection("127.0.0.1", port, wait=False).close()
        session.close()


def test_threads_that_want_the_same_module_look_it_up_once(robot, pool, monkeypatch):
    connection, find, asked = naoqi.connection(*robot.address), robot_connection.find_module, []
    both = threading.Event()

    def found(*arguments):
        asked.append(arguments)
        if len(asked) == 2:
            both.set()
        both.wait(0.1)  # for the other one, which must not come
        return find(*arguments)

    monkeypatch.setattr(robot_connection, "find_module", found)
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


def test_a_robot_that_goes_is_noticed_within_two_seconds_and_one_that_is_slow_is_waited_for():
    timing = Timing()
    assert timing.heartbeat_period < 2.0 and timing.heartbeat_period < timing.silence < SERVER_PATIENCE == 10.0
    assert timing.patience > SERVER_PATIENCE


def test_a_program_goes_on_with_a_robot_that_was_silent_for_more_than_ten_seconds(robot, proxy, pool, begun):
    fifth = {name: value / 5.0 for name, value in asdict(Timing()).items()}
    proxy.connection.timing = Timing(**fifth)
    under_way = pool.submit(proxy.begin)
    begun()
    robot.silence()
    waiting = pool.submit(proxy.add, 1, 2)
    time.sleep(11.0 / 5.0)
    robot.speak()
    assert waiting.result(SOON) == 3
    proxy.finish(6)
    assert under_way.result(SOON) == 6 and proxy.connection.generation == 1


class Silence:
    """Follows when a connection becomes silent, and when it is no longer: state, and whether it is."""

    def __init__(self, connection):
        self.seen, self._connection, self._news = [], connection, threading.Condition()
        connection.add_listener(self._hear, silence=True)

    def _hear(self, state):
        with self._news:
            self.seen.append((str(state), self._connection.silent > 0.0))
            self._news.notify_all()

    def wait_for(self, *seen):
        with self._news:
            self._news.wait_for(lambda: len(self.seen) >= len(seen), SOON)
            assert self.seen == list(seen)


def test_calls_under_way_new_ones_and_new_proxies_wait_for_a_silent_robot(robot, proxy, pool, begun, states, caplog):
    connection = proxy.connection
    connection.timing = Timing(heartbeat_period=0.05, silence=0.1, patience=SOON)
    under_way, followed, silence = pool.submit(proxy.begin), states(connection), Silence(connection)
    begun()
    robot.silence()
    silence.wait_for(SILENT)
    waiting = [
        pool.submit(proxy.add, 1, 2),
        pool.submit(lambda: proxy.call_async("add", 3, 4).result(timeout=0.2)),
        pool.submit(lambda: robot.proxy("Switch") and 5),
    ]
    assert wait(waiting, 0.5, FIRST_COMPLETED).done == set(), "the limit of a call is of a robot that answers"
    assert "silent" in repr(connection)
    robot.speak()
    assert [each.result(SOON) for each in waiting] == [3, 7, 5]
    silence.wait_for(SILENT, SPEAKING)
    proxy.finish(6)
    assert under_way.result(SOON) == 6
    assert followed.seen == [] and (connection.generation, connection.silent) == (1, 0.0)
    texts = [each.getMessage() for each in caplog.records if each.name == "naoqi"]
    assert len(texts) == 2 and f"calls wait for it, up to {SOON:g} s" in texts[0] and "answers again, after" in texts[1]


def test_a_call_that_the_robot_leaves_open_has_its_limit_while_it_answers_others(proxy):
    call = proxy.call_async("begin")
    with pytest.raises(errors.CallTimeout, match="0.3 s"):
        call.result(timeout=0.3)


@pytest.mark.parametrize("patience, state", [(3600.0, "connected"), (0.6, "lost")])
def test_a_connection_to_a_silent_robot_is_closed_soon(robot, proxy, patience, state):
    connection = proxy.connection
    connection.timing = Timing(heartbeat_period=0.05, silence=0.1, patience=patience)
    silence = Silence(connection)
    robot.silence()
    silence.wait_for(*([SILENT] if state == "connected" else [SILENT, ("lost", False)]))
    connection.close()
    assert connection.state == "closed"  # long before the patience is over


PROGRAM = """
import logging, sys, naoqi
logging.basicConfig(stream=sys.stdout, format="%(message)s")
proxy = naoqi.ALProxy("ALTest", "127.0.0.1", int(sys.argv[1]), patience=1.0)
call = proxy.call_async("begin")
print("ready", flush=True)
sys.stdin.readline()
print(call.done(), proxy.add(1, 2), proxy.connection.generation)
"""


def test_a_program_that_was_itself_stopped_does_not_take_the_robot_for_lost(robot):
    program = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(robot.port)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    with program:
        assert program.stdout.readline() == "ready\n"
        hold(program.pid)
        time.sleep(1.5)  # longer than its patience
        program.send_signal(signal.SIGCONT)
        assert program.communicate("\n", SOON)[0] == "False 3 1\n", "and it logs nothing"
