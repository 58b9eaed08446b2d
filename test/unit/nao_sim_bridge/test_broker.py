"""The simulator's side of libqi: where it listens, whom it serves, whom it calls, and a port that is free again."""

from __future__ import annotations

import logging
import os
import queue
import re
import socket
import subprocess
import sys
import threading

import pytest
import qi

from nao_sim_bridge import broker as module
from nao_sim_bridge.broker import Broker

# Listens on the port of its argument, says so, and stays until it is killed.
LISTENER = """
import sys
from nao_sim_bridge.broker import Broker
broker = Broker()
broker.listen("127.0.0.1", int(sys.argv[1]))
print(broker.port, flush=True)
sys.stdin.read()
"""


class Echo:
    """A module that is called."""

    def __init__(self):
        self.calls = queue.Queue()

    @qi.bind(qi.Void, [qi.Dynamic])
    def hear(self, value):
        self.calls.put(value)

    @qi.bind(qi.Void, [qi.Dynamic])
    def fail(self, value):
        raise ValueError(f"no, not {value}")


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

    def start(port, address="127.0.0.1"):
        session = qi.Session()
        session.connect(f"tcp://{address}:{port}")
        made.append(session)
        return session

    yield start
    for session in made:
        session.close()


@pytest.fixture
def own_address():
    """An address of this machine other than the loopback."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # sends nothing
            return probe.getsockname()[0]
        except OSError:
            pytest.skip("this machine has no network")


def accepts(address, port):
    with socket.socket() as probe:
        probe.settimeout(2.0)
        return probe.connect_ex((address, port)) == 0


# --- listening --------------------------------------------------------------------------------------------------------


def test_port_0_takes_a_free_port(listening):
    ports = [listening().port for _ in range(2)]
    assert all(1024 <= port <= 65535 for port in ports)
    assert ports[0] != ports[1]


def test_on_the_loopback_nobody_else_gets_in(listening, own_address):
    broker = listening("127.0.0.1")
    assert accepts("127.0.0.1", broker.port)
    assert not accepts(own_address, broker.port)


def test_on_all_addresses_everybody_gets_in(listening, own_address):
    broker = listening("0.0.0.0")
    assert accepts("127.0.0.1", broker.port)
    assert accepts(own_address, broker.port)


def test_a_port_where_somebody_listens_is_refused_at_once(listening, monkeypatch):
    port = listening().port
    monkeypatch.setattr(module.time, "sleep", lambda seconds: pytest.fail("waited for a port that is not being freed"))
    with pytest.raises(RuntimeError, match=f"cannot listen on 127.0.0.1:{port}: another program listens there"):
        listening(port=port)


def test_an_address_of_another_machine_is_refused(listening):
    with pytest.raises(RuntimeError, match="cannot listen on 192.0.2.1:0: "):
        listening("192.0.2.1")


def test_a_port_is_free_again_at_once_after_a_kill_with_clients_connected(connect, monkeypatch, listening):
    process = subprocess.Popen(
        [sys.executable, "-c", LISTENER, "0"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    port = int(process.stdout.readline())
    connect(port).service("ServiceDirectory").services()
    process.kill()
    process.communicate()
    monkeypatch.setattr(module.time, "sleep", lambda seconds: pytest.fail("the port was still held"))
    assert listening(port=port).port == port


def test_other_sockets_of_the_process_stay_as_they_are(listening):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        # As rospy does once a node has subscribed; then whatever turns a descriptor into a socket changes its mode.
        socket.setdefaulttimeout(60.0)
        try:
            listening()
        finally:
            socket.setdefaulttimeout(None)
        assert os.get_blocking(other.fileno())


# --- serving and calling ----------------------------------------------------------------------------------------------


def test_a_module_is_served_until_it_is_unregistered(listening, connect, patience):
    broker, echo = listening(), Echo()
    broker.register("Echo", echo)
    connect(broker.port).service("Echo").hear("hello")
    assert echo.calls.get(timeout=patience) == "hello"
    broker.unregister("Echo")
    broker.unregister("Echo")
    with pytest.raises(RuntimeError, match="Echo"):
        connect(broker.port).service("Echo")


def test_a_module_of_a_client_is_called_without_waiting(listening, connect, patience):
    broker, echo = listening(), Echo()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Echo", echo)
    for n in range(5):
        broker.call("Echo", "hear", [n])
    assert sorted(echo.calls.get(timeout=patience) for _ in range(5)) == list(range(5))


@pytest.mark.parametrize(
    "called, method, message",
    [
        ("Echo", "fail", "callback Echo.fail failed: .*no, not 3"),
        ("Echo", "nothing", "callback Echo.nothing failed"),
        ("Nobody", "hear", "callback Nobody.hear lost: no such module"),
    ],
)
def test_a_callback_that_fails_is_logged(listening, connect, patience, monkeypatch, called, method, message):
    logged = queue.Queue()
    handler = logging.Handler()
    handler.emit = lambda record: logged.put(record.getMessage())
    monkeypatch.setattr(module.log, "handlers", [handler])
    broker = listening()
    broker.register("Echo", Echo())
    broker.call(called, method, [3])
    assert re.search(message, logged.get(timeout=patience), re.DOTALL)


def test_its_name_is_what_modules_report(listening):
    assert listening(name="mine").name == "mine"


class Stuck:
    """A module whose method does not come back until it is let go."""

    def __init__(self):
        self.entered, self.let_go = threading.Event(), threading.Event()

    @qi.bind(qi.Void, [qi.Dynamic])
    def hear(self, value):
        self.entered.set()
        self.let_go.wait(30.0)


def callers_of(name):
    return [thread for thread in threading.enumerate() if thread.name == f"calls of {name}"]


def test_a_module_that_hangs_keeps_no_other_from_its_calls(listening, connect, patience):
    broker, stuck, echo = listening(), Stuck(), Echo()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Stuck", stuck)
    client.registerService("Echo", echo)
    try:
        broker.call("Stuck", "hear", [1])
        assert stuck.entered.wait(patience)
        broker.call("Stuck", "hear", [2])
        broker.call("Echo", "hear", [3])
        assert echo.calls.get(timeout=patience) == 3
    finally:
        stuck.let_go.set()


def test_a_thread_that_calls_a_module_ends_when_idle_and_the_next_call_gets_a_new_one(listening, patience, monkeypatch):
    monkeypatch.setattr(module, "CALLER_IDLE", 0.01)
    broker, echo = listening(), Echo()
    broker.register("Idle", echo)
    broker.call("Idle", "hear", [1])
    (first,) = callers_of("Idle") or [None]
    assert echo.calls.get(timeout=patience) == 1
    if first is not None:
        first.join(patience)
        assert not first.is_alive()
    broker.call("Idle", "hear", [2])
    assert echo.calls.get(timeout=patience) == 2


def test_a_broker_that_closes_ends_its_threads(listening, patience):
    broker, echo = listening(), Echo()
    broker.register("Closing", echo)
    broker.call("Closing", "hear", [1])
    assert echo.calls.get(timeout=patience) == 1
    (thread,) = callers_of("Closing")
    broker.close()
    thread.join(patience)
    assert not thread.is_alive()
    broker.call("Closing", "hear", [2])
    assert callers_of("Closing") == []
