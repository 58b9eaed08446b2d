"""A robot to talk to, real down to the wire, and waits that end as soon as they can."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from waits import hold

import naoqi

SERVER = Path(__file__).with_name("robot_server.py")
PATIENCE = 60.0
"""Longest wait for something that must happen, in s; passing tests do not come near it."""


class Robot:
    """The process of `robot_server.py`: it can be stopped, continued, killed and started again."""

    def __init__(self):
        self.port = 0
        self._process = None
        self.start()

    def start(self):
        """Start it, on the port it had before."""
        command = [sys.executable, str(SERVER), str(self.port)]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, stderr=subprocess.DEVNULL
        )
        answer = self._process.stdout.readline().split()
        assert answer[:1] == ["ready"], f"the server did not start on port {self.port}"
        self.port = int(answer[1])

    def kill(self):
        self._process.kill()
        self._process.wait()
        self._process.stdin.close()
        self._process.stdout.close()

    def silence(self):
        """As if the network cable were pulled: sockets stay open, nothing answers."""
        hold(self._process.pid)

    def speak(self):
        self._process.send_signal(signal.SIGCONT)

    @property
    def address(self):
        return "127.0.0.1", self.port

    def proxy(self, name="ALTest", **options):
        return naoqi.ALProxy(name, *self.address, **options)


def _running():
    """A robot: one for each test that breaks it, and one for all others."""
    robot = Robot()
    yield robot
    naoqi.connection(*robot.address, wait=False).close()
    robot.kill()


fragile_robot, shared_robot = pytest.fixture(_running), pytest.fixture(_running, scope="session")


@pytest.fixture
def robot(shared_robot):
    """A robot that nobody waits for."""
    shared_robot.proxy().forget()
    return shared_robot


@pytest.fixture
def proxy(robot):
    return robot.proxy()


class States:
    """Follows a connection through its states."""

    def __init__(self, connection):
        self.seen = []
        self._condition = threading.Condition()
        connection.add_listener(self._hear)

    def _hear(self, state):
        with self._condition:
            self.seen.append(str(state))
            self._condition.notify_all()

    def wait_for(self, *states):
        """Wait until exactly these have been seen."""
        with self._condition:
            self._condition.wait_for(lambda: len(self.seen) >= len(states), PATIENCE)
            assert self.seen == list(states)


@pytest.fixture
def begun(proxy, eventually):
    """Waits until a call of `begin` has arrived at the robot."""
    return lambda: eventually(lambda: proxy.begun() > 0, "the call arrives")


@pytest.fixture
def states():
    """Makes a follower of the states of a connection."""
    return States
