"""The program `python -m nao_sim_bridge` from its start to its exit status."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys

import pytest
import qi

LISTENS = re.compile(r"listens on 127\.0\.0\.1:(\d+)")


class Program:
    """A running simulator."""

    def __init__(self, *arguments, port=0):
        command = [sys.executable, "-m", "nao_sim_bridge", "--port", str(port), *arguments]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        self.process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment
        )
        self.said = []

    def port(self):
        """The port it says it listens on."""
        for line in self.process.stderr:
            self.said.append(line)
            match = LISTENS.search(line)
            if match:
                return int(match.group(1))
        raise AssertionError("it ended: " + "".join(self.said))

    def status(self, patience):
        """Its exit status, after it has ended."""
        self.said.append(self.process.communicate(timeout=patience)[1])
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
def used():
    """Calls of every kind to a simulator, some of which still run."""
    sessions = []

    def use(port):
        session = qi.Session()
        session.connect(f"tcp://127.0.0.1:{port}")
        sessions.append(session)
        session.service("NaoSimulation").advance(0.1)
        session.service("ALLeds").fade("FaceLeds", 0.0, 100.0, _async=True)
        session.service("ALMotion").call("wakeUp", _async=True)
        assert session.service("ALMotion").ping() is True
        return session

    yield use
    for session in sessions:
        session.close()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_in_order_while_calls_run(program, used, patience, number):
    running = program("--paused")
    used(running.port())
    running.process.send_signal(number)
    assert running.status(patience) == 0, running.said


def test_after_a_kill_it_can_start_again_on_its_port_at_once(program, used, patience):
    """Neither its clients nor the process that draws pictures may keep the port."""
    killed = program("--paused")
    port = killed.port()
    assert used(port).service("NaoSimulation").picture("front", 16, 16)
    killed.process.kill()
    killed.status(patience)
    again = program("--paused", port=port)
    assert again.port() == port
    assert not any("waiting" in line for line in again.said)


def test_a_client_can_shut_it_down(program, used, patience):
    running = program("--speed", "max")
    used(running.port()).service("ALSystem").call("shutdown", _async=True)
    assert running.status(patience) == 0, running.said


@pytest.mark.parametrize(
    "arguments, message",
    [
        (("--world", "moon"), "no world 'moon'.*empty"),
        (("--listen", "192.0.2.1"), "cannot listen on 192.0.2.1:0"),
    ],
)
def test_what_keeps_it_from_starting_is_said_in_one_line(program, patience, arguments, message):
    ended = program(*arguments)
    assert ended.status(patience) == 1
    assert re.search(rf"\[nao_sim\] ERROR .*{message}", ended.said[-1])
    assert "Traceback" not in ended.said[-1]
