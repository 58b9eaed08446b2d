"""What hangs or fails beside the simulator, and ends nothing of it."""

from __future__ import annotations

import socket
import threading
from unittest.mock import MagicMock

import rospy

from nao_sim_bridge.base.guard import Guard
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
