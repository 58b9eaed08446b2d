"""A stack of one's own: waiting for what it brings up, and hearing of its end. A program stands in for roslaunch."""

from __future__ import annotations

import socket
import time

import pytest

from nao_library_modules.own_stack import OwnStack, can_connect, free_port

LIMIT = 20.0
LISTENER = """#!/usr/bin/env python3
import signal, socket, sys
ports = [int(sys.argv[2]), *(int(word.split(":=")[1]) for word in sys.argv if word.startswith("nao_port"))]
sockets = [socket.create_server(("127.0.0.1", port)) for port in ports]
signal.pause()
"""
SILENT = "#!/bin/sh\nexec sleep 1000\n"
BROKEN = "#!/bin/sh\necho begun\necho no such file: nao_sim.launch\n"


@pytest.fixture
def stack(tmp_path, monkeypatch):
    made = []

    def make(program):
        (tmp_path / "roslaunch").write_text(program)
        (tmp_path / "roslaunch").chmod(0o755)
        monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
        made.append(OwnStack(tmp_path / "log", {}))
        return made[-1]

    yield make
    for one in made:
        one.stop()


def test_master_and_robot_are_waited_for_and_are_gone_after_the_end(stack):
    one = stack(LISTENER)
    one.wait_for_master(LIMIT)
    one.wait_for_robot(LIMIT)
    assert one.alive() and can_connect(one.ros_port) and can_connect(one.nao_port)
    one.stop()
    assert not one.alive() and not can_connect(one.ros_port)


@pytest.mark.parametrize(
    "wait, what", [("wait_for_master", "the ROS master"), ("wait_for_robot", "the simulated robot")]
)
def test_the_end_of_roslaunch_ends_the_waiting_with_its_last_words(stack, wait, what):
    began = time.monotonic()
    with pytest.raises(TimeoutError, match=f"{what} does not come up: roslaunch has ended: no such file: nao_sim"):
        getattr(stack(BROKEN), wait)(LIMIT)
    assert time.monotonic() - began < LIMIT / 2


def test_waiting_has_an_end(stack):
    with pytest.raises(TimeoutError, match="the ROS master does not come up: not there within 0.2 s"):
        stack(SILENT).wait_for_master(0.2)


def test_a_free_port_can_be_listened_at():
    with socket.create_server(("127.0.0.1", free_port())):
        pass
