"""A program that is kept running. Real processes; every wait ends with what it waits for."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
import threading

import pytest

from nao_library_modules.core.processes import RestartTiming, Supervisor, SupervisorState, descendants, identify

LIMIT = 60.0
QUICK = RestartTiming(first_delay=0.01, longest_delay=0.04, interrupt=LIMIT, terminate=0.2, kill=LIMIT)
SAY = "import os, sys; pipe = open(sys.argv[1], 'w', buffering=1); say = lambda *a: print(*a, file=pipe); "
FOREVER = "import signal, threading; threading.Event().wait()"


class Pipe:
    """A pipe that programs write lines to, so that a test waits for what they say."""

    def __init__(self, path):
        os.mkfifo(path)
        self.path = str(path)
        # Opened for both directions: opening does not wait, and it never ends while programs come and go.
        self._descriptor = os.open(path, os.O_RDWR)
        self._text = b""

    def line(self):
        while b"\n" not in self._text:
            self._text += os.read(self._descriptor, 1000)
        line, _, self._text = self._text.partition(b"\n")
        return line.decode()


@pytest.fixture
def pipe(tmp_path):
    return Pipe(tmp_path / "pipe")


@pytest.fixture
def supervise(pipe):
    """Makes supervisors of Python programs that write to the pipe; stops them at the end."""
    made = []

    def make(program, *args, timing=QUICK, environment=None):
        made.append(Supervisor([sys.executable, "-c", program, pipe.path, *args], "the program", environment, timing))
        made[-1].start()
        return made[-1]

    yield make
    for supervisor in made:
        supervisor.stop()


def test_it_runs_with_its_environment_until_stopped_and_again(supervise, pipe):
    program = SAY + "say(os.getpid(), os.environ['ROS_NAMESPACE']); " + FOREVER
    supervisor = supervise(program, environment={"ROS_NAMESPACE": "/robot1/"})
    pid, namespace = pipe.line().split()
    assert namespace == "/robot1/"
    assert (supervisor.status.state, supervisor.status.pid) == (SupervisorState.RUNNING, int(pid))
    supervisor.stop()
    assert identify(int(pid)) is None and supervisor.status.state is SupervisorState.STOPPED
    supervisor.start()
    assert pipe.line().split()[0] != pid
    Supervisor(["true"], "the program").stop()  # what never started


def test_a_program_that_dies_is_started_again_and_the_log_says_how_it_ended(supervise, pipe, caplog):
    caplog.set_level(logging.INFO)
    supervisor = supervise(SAY + "say(os.getpid()); sys.exit(3)")
    assert len({pipe.line() for _ in range(6)}) == 6, "a process each time"
    supervisor.stop()
    assert supervisor.status.restarts >= 5
    assert "the program ended by itself with exit status 3; it is started again in 0.01 s" in caplog.text
    delays = [record.args[2] for record in caplog.records if "started again" in record.msg]
    assert delays[:5] == [0.01, 0.02, 0.04, 0.04, 0.04], "the delay doubles up to its limit"


def test_a_program_that_ignores_polite_signals_is_killed(supervise, pipe, caplog):
    deaf = SAY + "import signal; [signal.signal(s, signal.SIG_IGN) for s in (2, 15)]; say(os.getpid()); " + FOREVER
    supervisor = supervise(deaf, timing=RestartTiming(interrupt=0.05, terminate=0.05, kill=LIMIT))
    pid = int(pipe.line())
    supervisor.stop()
    assert identify(pid) is None and "did not end within 0.05 s of SIGTERM" in caplog.text


def test_nothing_it_started_is_left_behind_not_even_in_a_session_of_its_own(supervise, pipe, tmp_path):
    held_open = tmp_path / "held_open"
    os.mkfifo(held_open)
    end_of_grandchild = os.open(held_open, os.O_RDONLY | os.O_NONBLOCK)
    grandchild = SAY + "held = open(sys.argv[2], 'w'); say(os.getpid()); " + FOREVER
    child = "subprocess.Popen([sys.executable, '-c', sys.argv[3], *sys.argv[1:3]], start_new_session=True); "
    supervisor = supervise("import subprocess, sys; " + child + FOREVER, str(held_open), grandchild)
    assert identify(int(pipe.line())) in descendants(os.getpid())
    supervisor.stop()
    os.set_blocking(end_of_grandchild, True)
    assert os.read(end_of_grandchild, 1) == b""


def test_stopping_during_the_delay_does_not_start_it_again(supervise, pipe):
    supervisor = supervise(SAY + "say('up')", timing=RestartTiming(first_delay=60.0, interrupt=LIMIT, kill=LIMIT))
    pipe.line()
    supervisor.stop()
    assert (supervisor.status.state, supervisor.status.restarts) == (SupervisorState.STOPPED, 0)


def test_it_ends_when_the_process_that_supervises_it_is_killed(pipe):
    program = SAY + "say(os.getpid()); " + FOREVER
    owner = (
        "import sys, threading; from nao_library_modules.core.processes import Supervisor; "
        "Supervisor([sys.executable, '-c', *sys.argv[1:]], 'the program').start(); threading.Event().wait()"
    )
    supervising = subprocess.Popen([sys.executable, "-c", owner, program, pipe.path])
    pid = int(pipe.line())
    supervising.kill()
    supervising.wait(LIMIT)
    assert any(identify(pid) is None or threading.Event().wait(0.05) for _ in range(1200)), f"process {pid} goes on"
