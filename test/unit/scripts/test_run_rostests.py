from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys

import pytest
import run_rostests
from run_rostests import MARGIN, MARK, ROBOTS, free_port, in_groups, processes_of, time_limit


@pytest.mark.parametrize(
    "text, seconds",
    [
        ('<launch><test time-limit="20"/><node/></launch>', 20.0),
        ('<launch><test/><group><test time-limit="5" retry="1"/></group></launch>', 70.0),
        ('<launch><test time-limit="$(arg limit)"/></launch>', 60.0),
        ("<launch><test", 0.0),
    ],
)
def test_a_scenario_may_take_as_long_as_its_tests_and_a_margin(tmp_path, text, seconds):
    scenario = tmp_path / "lights.test"
    scenario.write_text(text)
    assert time_limit(scenario) == MARGIN + seconds


def test_a_free_port_can_be_listened_on():
    port = free_port()
    for wanted in range(port, port + ROBOTS):
        with socket.socket() as server:
            server.bind(("127.0.0.1", wanted))
            assert server.getsockname() == ("127.0.0.1", wanted)


def test_ports_in_use_are_left_out(monkeypatch):
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        used = server.getsockname()[1]
        other = free_port()
        choices = iter([used, used - 1, other])
        monkeypatch.setattr(run_rostests.random, "choice", lambda ports: next(choices))
        assert free_port() == other


def test_long_scenarios_begin_and_those_that_want_to_be_alone_come_last_one_by_one(tmp_path):
    texts = {"short": '<test time-limit="10"/>', "quiet": "<!-- alone: ... -->", "long": '<test time-limit="300"/>'}
    scenarios = []
    for name, text in texts.items():
        scenarios.append(tmp_path / f"{name}.test")
        scenarios[-1].write_text(f"<launch>{text}</launch>")
    scenarios = [path.relative_to(tmp_path) for path in scenarios]
    names = [(count, [path.stem for path in group]) for count, group in in_groups(tmp_path, scenarios, 2)]
    assert names == [(2, ["long", "short"]), (1, ["quiet"])]
    assert in_groups(tmp_path, scenarios, 1) == [(1, scenarios)]


def test_processes_are_known_by_their_mark_until_they_end():
    mark = f"test-{os.getpid()}"
    program = "print('up', flush=True); import signal; signal.pause()"
    child = subprocess.Popen(
        [sys.executable, "-c", program], env={**os.environ, MARK: mark}, stdout=subprocess.PIPE, text=True
    )
    with child:
        assert child.stdout.readline() == "up\n"
        assert list(processes_of(mark)) == [child.pid]
        assert processes_of(mark + "0") == {}
        child.send_signal(signal.SIGTERM)
        child.wait(timeout=10)
        assert processes_of(mark) == {}
