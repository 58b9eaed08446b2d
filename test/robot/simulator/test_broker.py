"""The simulator's side of libqi: where it listens, whom it serves, whom it calls, and a port that is free again."""

import os
import queue
import re
import signal
import socket
import subprocess
import sys
import threading

import pytest
import qi
from simulator import PATIENCE, connected

from nao_sim_bridge import broker as module
from nao_sim_bridge.broker import Broker

LISTENS = re.compile(r"listens on 127\.0\.0\.1:(\d+)")


class Echo:
    """A module that is called, and can be held up."""

    def __init__(self, held_up=False):
        self.calls, self.entered, self.let_go = queue.Queue(), threading.Event(), threading.Event()
        if not held_up:
            self.let_go.set()

    @qi.bind(qi.Void, [qi.Dynamic])
    def hear(self, value):
        self.entered.set()
        self.let_go.wait(PATIENCE)
        self.calls.put(value)


@pytest.fixture
def listening():
    """Starts brokers that listen on a free port of an address."""
    made = []

    def start(address="127.0.0.1", port=0, name="test"):
        made.append(Broker(name))
        made[-1].listen(address, port)
        return made[-1]

    yield start
    for broker in made:
        broker.close()


@pytest.fixture
def connect():
    """Makes clients."""
    made = []

    def start(port):
        made.append(connected(port))
        return made[-1]

    yield start
    for session in made:
        session.close()


def test_a_broker_that_closes_ends_the_threads_of_its_calls(listening):
    broker, echo = listening(), Echo()
    broker.register("Closing", echo)
    broker.call("Closing", "hear", [1])
    assert echo.calls.get(timeout=PATIENCE) == 1
    (caller,) = (thread for thread in threading.enumerate() if thread.name == "calls of Closing")
    broker.close()
    caller.join(PATIENCE)
    assert not caller.is_alive()


def accepts(address, port):
    with socket.socket() as probe:
        probe.settimeout(2.0)
        return probe.connect_ex((address, port)) == 0


def test_it_listens_on_its_address_only_and_on_a_free_port(listening):
    loopback, everywhere = listening("127.0.0.1"), listening("0.0.0.0", name="mine")
    assert loopback.port != everywhere.port and everywhere.name == "mine"
    assert all(1024 <= broker.port <= 65535 for broker in (loopback, everywhere))
    reached = [accepts(a, broker.port) for broker in (loopback, everywhere) for a in ("127.0.0.1", "127.0.0.2")]
    assert reached == [True, False, True, True]


def test_what_cannot_be_listened_on_is_refused_at_once(listening, monkeypatch):
    port = listening().port
    monkeypatch.setattr(module.time, "sleep", lambda seconds: pytest.fail("waited for a port that is not being freed"))
    with pytest.raises(RuntimeError, match=f"cannot listen on 127.0.0.1:{port}: another program listens there"):
        listening(port=port)
    with pytest.raises(RuntimeError, match="cannot listen on 192.0.2.1:0: "):
        listening("192.0.2.1")


def test_modules_of_clients_are_called_in_order_and_one_that_hangs_holds_up_no_other(listening, connect):
    broker, stuck, echo = listening(), Echo(held_up=True), Echo()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Stuck", stuck)
    client.registerService("Echo", echo)
    broker.call("Stuck", "hear", [1])
    assert stuck.entered.wait(PATIENCE)
    broker.call("Stuck", "hear", [2])
    for n in range(5):
        broker.call("Echo", "hear", [n])
    assert sorted(echo.calls.get(timeout=PATIENCE) for _ in range(5)) == list(range(5))
    broker.drop_calls()
    stuck.let_go.set()
    assert stuck.calls.get(timeout=PATIENCE) == 1
    broker.call("Stuck", "hear", [3])
    assert stuck.calls.get(timeout=PATIENCE) == 3  # the one that waited was dropped


class Program:
    """A running simulator."""

    def __init__(self, *arguments, port=0):
        command = [sys.executable, "-m", "nao_sim_bridge", "--port", str(port), *arguments]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        output = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
        self.process = subprocess.Popen(command, env=environment, **output)
        self.said = []

    def port(self):
        """The port it says it listens on."""
        for line in self.process.stderr:
            self.said.append(line)
            match = LISTENS.search(line)
            if match:
                return int(match.group(1))
        raise AssertionError("it ended: " + "".join(self.said))

    def status(self):
        """Its exit status, after it has ended."""
        self.said.append(self.process.communicate(timeout=4 * PATIENCE)[1])
        return self.process.returncode


@pytest.fixture
def program():
    """Starts programs; those that still run are killed after the test."""
    started = []

    def start(*arguments, **options):
        started.append(Program(*arguments, **options))
        return started[-1]

    yield start
    for one in started:
        if one.process.poll() is None:
            one.process.kill()
            one.process.communicate()


@pytest.fixture
def used(connect):
    """Calls of every kind to a simulator, some of which still run."""

    def use(port):
        session = connect(port)
        session.service("NaoSimulation").advance(0.1)
        session.service("ALLeds").fade("FaceLeds", 0.0, 100.0, _async=True)
        session.service("ALMotion").call("wakeUp", _async=True)
        assert session.service("ALMotion").ping() is True
        return session

    return use


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGINT, "shutdown"])
def test_a_signal_or_a_client_ends_the_program_in_order_while_calls_run(program, used, end):
    running = program("--paused")
    session = used(running.port())
    if end == "shutdown":
        session.service("ALSystem").call("shutdown", _async=True)
    else:
        running.process.send_signal(end)
    assert running.status() == 0, running.said


def test_after_a_kill_it_can_start_again_on_its_port_at_once(program, used):
    """Neither its clients nor the process that draws pictures may keep the port."""
    killed = program("--paused")
    port = killed.port()
    assert used(port).service("NaoSimulation").picture("front", 16, 16)
    killed.process.kill()
    killed.status()
    again = program("--paused", port=port)
    assert again.port() == port and not any("waiting" in line for line in again.said)


def test_what_keeps_it_from_starting_is_said_in_one_line(program):
    ended = program("--world", "moon")
    assert ended.status() == 1
    assert re.search(r"\[nao_sim\] ERROR .*no world 'moon'.*empty", ended.said[-1])
