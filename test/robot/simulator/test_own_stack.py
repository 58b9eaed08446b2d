"""A stack of one's own: what is told when it does not come up."""

from __future__ import annotations

import signal
import socket
from contextlib import ExitStack
from pathlib import Path

import pytest
import qi
import rosgraph

from nao_library_modules.ros.own_stack import OwnMaster, OwnStack, StackFailed, fatal_words, last_words

MORTAL = """<launch>
  <node pkg="rostopic" type="rostopic" name="mortal" args="echo /nothing" launch-prefix="{}" output="screen"/>
</launch>"""
LOG = """[INFO] [/nao_sim]: it begins
[FATAL] [/NaoLights]: no such LED
[INFO] [/NaoMotion]: NaoMotion is ready
Segmentation fault
[I] 1795972224.145697 7716 qi.eventloop: Spawning 1 more thread.
[roslaunch] [nao_sim-1] process has died [pid 4711, exit code -11, cmd /ws/lib/nao_sim]
"""


def test_a_launch_that_is_refused_is_told_at_once_with_the_reason(tmp_path):
    with OwnStack(tmp_path / "log.txt", {}, launch=("nao_library", "no_such.launch")) as stack:
        with pytest.raises(StackFailed, match="the simulated robot does not come up: its launch ends: .*no_such"):
            stack.wait_for_robot(60.0)


def test_the_end_of_a_process_is_told_at_once_with_its_own_last_line(tmp_path):
    launch = tmp_path / "mortal.launch"
    launch.write_text(MORTAL.format(tmp_path / "mortal.sh"))
    (tmp_path / "mortal.sh").write_text("#!/bin/sh\necho the gyroscope is missing >&2\nexit 7\n")
    (tmp_path / "mortal.sh").chmod(0o755)
    with OwnStack(tmp_path / "log.txt", {}, launch=(str(launch),)) as stack:
        with pytest.raises(
            StackFailed, match="a server does not come up: /mortal .* 7: the gyroscope is missing"
        ) as told:
            stack.wait_until(lambda: False, "a server", 60.0)
    assert (told.value.process, told.value.status) == ("/mortal", 7)


def test_the_last_words_of_a_node_are_its_own(tmp_path):
    log = tmp_path / "log.txt"
    log.write_text(LOG)
    assert last_words(log, "/nao_sim") == "Segmentation fault"  # no program has put its name to it
    log.write_text(LOG.replace("Segmentation fault\n", ""))
    assert last_words(log, "/nao_sim") == "it begins"
    assert fatal_words(log) == "/NaoLights: no such LED"


def test_a_stack_comes_up_while_another_program_takes_each_port_that_is_let_go(tmp_path, thief):
    launch = ("nao_library_tests", "simulator_only.launch")
    with OwnStack(tmp_path / "log.txt", {}, launch=launch) as stack:
        stack.wait_for_robot()
        session = qi.Session()
        session.connect(f"tcp://127.0.0.1:{stack.nao_port}")
        assert session.service("ALMotion").getAngles("HeadYaw", True)
        session.close()
        assert stack.nao_port not in thief and rosgraph.Master("/test", stack.master_uri).getPid() == stack.pid


def test_masters_side_by_side_each_have_a_port_of_their_own(tmp_path, thief):
    with ExitStack() as held:
        masters = [held.enter_context(OwnMaster(tmp_path / f"{number}.txt")) for number in range(4)]
        assert [rosgraph.Master("/test", one.uri).getPid() for one in masters] == [one.pid for one in masters]
    assert not any(one.alive() for one in masters)


@pytest.fixture
def thief(monkeypatch):
    """Listens at once on each port that this process has bound and lets go; has the ports."""
    let_go, taken = socket.socket.close, {}

    def close(closed):
        port = 0
        try:
            port = closed.getsockname()[1] if closed.family == socket.AF_INET else 0
            connected = bool(closed.getpeername())
        except OSError:  # not bound, closed before, or not connected
            connected = False
        let_go(closed)
        if port and not connected and port not in taken:
            taken[port] = socket.create_server(("127.0.0.1", port))

    monkeypatch.setattr(socket.socket, "close", close)
    yield taken
    monkeypatch.undo()
    for listener in taken.values():
        listener.close()


def test_a_program_that_blocks_ctrl_c_can_end_its_stack(tmp_path):
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        stack = OwnStack(tmp_path / "log.txt", {})
        blocked = signal.pthread_sigmask(signal.SIG_BLOCK, [])
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    with stack:
        words = (Path("/proc") / str(stack.pid) / "status").read_text().split()
    assert signal.SIGINT in blocked
    assert not int(words[words.index("SigBlk:") + 1], 16) & 1 << signal.SIGINT - 1
