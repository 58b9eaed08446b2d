"""A ROS master that is gone or was started again is told of in the log, with what to do; whether a node runs."""

from __future__ import annotations

import logging
import signal
import socket
import sys
import threading
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from nao_library_modules.ros import master_api, node
from nao_library_modules.ros.master_api import MasterCheck, node_runs


class Master:
    """Answers as a ROS master, and as a node, does."""

    def __init__(self):
        self._server = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
        self.uri = f"http://127.0.0.1:{self._server.server_address[1]}/"
        self.pid, self.nodes, self.parameters = 1, {}, {}
        self._server.register_function(lambda caller: (1, "", self.pid), "getPid")
        self._server.register_function(self._look_up, "lookupNode")
        self._server.register_function(self._get, "getParam")
        self._server.register_function(self._set, "setParam")
        threading.Thread(target=self._server.serve_forever, args=(0.01,), daemon=True).start()

    def close(self):
        self._server.shutdown()
        self._server.server_close()

    def _look_up(self, _caller, name):
        return (1, "", self.nodes[name]) if name in self.nodes else (-1, "unknown node", "")

    def _get(self, _caller, name):
        return (1, "", self.parameters[name]) if name in self.parameters else (-1, "not set", 0)

    def _set(self, _caller, name, value):
        self.parameters[name] = value
        return 1, "", 0


@pytest.fixture
def master(monkeypatch):
    made = Master()
    monkeypatch.setenv("ROS_MASTER_URI", made.uri)
    yield made
    made.close()


@pytest.fixture
def check(monkeypatch):
    """A check of a master that looks when the test says so."""
    monkeypatch.setattr(master_api, "CHECK_PERIOD", 3600.0)
    checks = []

    def make(uri):
        checks.append(MasterCheck(uri, "/test"))
        return checks[-1]

    yield make
    for each in checks:
        each.close()


@pytest.fixture
def silent(monkeypatch):
    """Address at which something takes connections and never answers."""
    monkeypatch.setattr(master_api, "LIMIT", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/"


@pytest.fixture
def ended():
    """Address of a process that has ended."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return f"http://127.0.0.1:{listener.getsockname()[1]}/"


def test_a_master_that_was_started_again_is_told_once_with_what_to_do(master, check, caplog):
    looks = check(master.uri)
    looks.look()
    assert not caplog.records
    master.pid = 2
    looks.look()
    looks.look()
    assert [record.levelno for record in caplog.records] == [logging.ERROR]
    assert "knows none of these nodes: end this launch and start it again" in caplog.text


@pytest.mark.parametrize("address", ["silent", "ended"])
def test_a_master_that_does_not_answer_is_told_once_and_hangs_nothing(address, check, caplog, request):
    looks = check(request.getfixturevalue(address))
    looks.look()
    looks.look()
    assert [record.levelno for record in caplog.records] == [logging.WARNING]
    assert "does not answer" in caplog.text and "start it again" in caplog.text


def test_a_master_that_only_hung_needs_nothing(master, check, silent, caplog):
    caplog.set_level(logging.INFO)
    looks = check(master.uri)
    for uri in master.uri, silent, master.uri:
        looks.uri = uri
        looks.look()
    assert [record.levelno for record in caplog.records] == [logging.WARNING, logging.INFO]
    assert "answers again" in caplog.text


def test_a_node_runs_if_it_lives_or_is_busy_and_not_if_it_died_or_is_unknown_or_there_is_no_master(
    master, silent, ended, monkeypatch
):
    master.nodes = {"/lives": master.uri, "/busy": silent, "/died": ended}
    assert [node_runs(name) for name in ("/lives", "/busy", "/died", "/unknown")] == [True, True, False, False]
    assert not node_runs("/lives", but=master.uri)
    monkeypatch.setenv("ROS_MASTER_URI", ended)
    assert not node_runs("/lives")


def test_a_launched_program_that_was_replaced_waits_for_its_name_and_any_other_takes_it(master, monkeypatch):
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    monkeypatch.setattr(sys, "argv", ["/opt/ours", "__name:=lights", "__log:=ours.log"])
    monkeypatch.setenv("ROS_NAMESPACE", "/robot")
    name = node.launched_name("NaoLights")
    master.nodes[name] = master.uri
    node.note_replaced(name)
    monkeypatch.setattr(sys, "argv", ["/opt/theirs", *sys.argv[1:]])
    node.wait_for_name(name)
    monkeypatch.setattr(sys, "argv", ["/opt/ours", *sys.argv[1:]])
    looks = []
    monkeypatch.setattr(node.time, "sleep", lambda _: looks.append(1) or master.nodes.clear())
    try:
        node.wait_for_name(name)
        node.wait_for_name(name)
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    assert name == "/robot/lights" and looks == [1] and master.parameters == {"/robot/lights/replaced": []}
