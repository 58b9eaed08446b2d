"""What hangs or fails beside the simulator, and ends nothing of it."""

from __future__ import annotations

import socket
import threading
from unittest.mock import MagicMock

import pytest
import qi
import rospy

from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.naoqi.binding.client_calls import answer
from nao_sim_bridge.ros import node as ros_node
from nao_sim_bridge.ros import side as ros_side
from nao_sim_bridge.server import own_sockets

LIMIT = 60.0


def test_a_node_that_was_stopped_does_not_hold_the_start_up(monkeypatch):
    monkeypatch.setattr(ros_node, "ANSWER_LIMIT", 0.05)
    before = socket.getdefaulttimeout()  # rospy has one of its own
    with socket.create_server(("127.0.0.1", 0)) as stopped:
        uri = f"http://127.0.0.1:{stopped.getsockname()[1]}"
        monkeypatch.setattr(ros_node.rosgraph.Master, "lookupNode", lambda *_: uri)
        assert not ros_node.answers("/nao_sim")
    assert socket.getdefaulttimeout() == before


def test_a_client_that_closes_while_it_is_cut_off_does_not_end_the_watch(monkeypatch):
    monkeypatch.setattr(own_sockets, "STUCK", 0.0)
    monkeypatch.setattr(own_sockets, "LOOK_PERIOD", 0.001)
    cut, connections = threading.Event(), {"gone": MagicMock(), "there": MagicMock()}
    for connection in connections.values():
        connection.getsockopt.return_value = own_sockets.SENT_AND_TAKEN.pack(0, 7)
    connections["gone"].shutdown.side_effect = OSError("Transport endpoint is not connected")
    connections["there"].shutdown.side_effect = lambda _: cut.set()
    rows = [own_sockets._Row(name, 1, own_sockets.CONNECTED, own_sockets.NO_ROOM, name) for name in connections]
    monkeypatch.setattr(own_sockets, "_rows", lambda *_: rows)
    monkeypatch.setattr(own_sockets, "_sockets", lambda link: [connections[link]])
    watch = own_sockets.StuckClients(1)
    assert cut.wait(LIMIT)
    watch.close()


@pytest.fixture
def full(monkeypatch):
    """The connection of a client that takes nothing."""
    connection = MagicMock()
    connection.getsockopt.return_value = own_sockets.SENT_AND_TAKEN.pack(0, 7)
    row = own_sockets._Row("full", 1, own_sockets.CONNECTED, own_sockets.NO_ROOM, "full")
    monkeypatch.setattr(own_sockets, "_rows", lambda *_: [row])
    monkeypatch.setattr(own_sockets, "_sockets", lambda _: [connection])
    return connection


def test_time_in_which_the_simulator_was_stopped_is_not_counted_against_a_client(monkeypatch, full):
    monkeypatch.setattr(own_sockets, "IDLE_PERIOD", 2.0)
    monkeypatch.setattr(own_sockets.threading, "Thread", MagicMock())
    watch = own_sockets.StuckClients(1)
    for _ in range(3):
        watch._look(60.0)
    full.shutdown.assert_not_called()
    for _ in range(round(own_sockets.STUCK / 0.5)):
        watch._look(0.5)
    full.shutdown.assert_called()


def test_an_answer_that_is_read_after_the_limit_counts_for_a_process_that_was_stopped():
    promise = qi.Promise()

    class Stopped(threading.Condition):
        """Continues when the limit is over, and reads the answer then."""

        def wait_for(self, predicate, timeout=None):
            if not predicate() and not promise.future().isFinished() and self.waits:
                promise.setValue(5)
            self.waits += 1
            return predicate()

        waits = 0

    assert answer(promise.future(), Stopped(), lambda: True, 10.0) == 5


def test_the_clock_goes_on_whatever_fails_beside_it(monkeypatch):
    server, told, enough = MagicMock(), [], threading.Event()
    server.simulation.shared.guard = guard = Guard()
    server.now = (None, 1.0)

    def publish(message):
        told.append(message.to_sec())
        if len(told) == 4:
            enough.set()
        raise rospy.ROSException("publish() to a closed topic")

    def broken():
        raise ValueError

    monkeypatch.setattr(rospy, "Service", MagicMock())
    monkeypatch.setattr(rospy, "Publisher", lambda *_, **__: MagicMock(publish=publish))
    monkeypatch.setattr(ros_side, "RosDiagnostics", lambda _: MagicMock(tick=broken))
    monkeypatch.setattr(ros_side, "BoundPorts", lambda _: MagicMock(tick=broken))
    monkeypatch.setattr(ros_side, "RosRobot", lambda *_: MagicMock(tick=broken))
    monkeypatch.setattr(ros_side, "ShapesTopic", lambda _: MagicMock(tick=broken))
    side = ros_side.RosSide(server, True)
    assert enough.wait(LIMIT)
    side.close()
    assert set(told) == {1.0} and {one.error.partition(":")[0] for one in guard.failures()} == {
        "ROSException",
        "ValueError",
    }
