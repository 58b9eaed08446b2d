from __future__ import annotations

import os
import select
import signal
import sys

import pytest
from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.program import Program

LIMIT = 20.0
DEAF = "from signal import *; signal(SIGINT, SIG_IGN); print('deaf', flush=True); pause()"
WAITING = "import signal; print('port 4711', flush=True); signal.pause()"


def python(text, **environment):
    return Program("a program", [sys.executable, "-c", text], environment)


def alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_it_waits_for_a_line_and_gives_what_matched():
    with python(WAITING) as program:
        assert program.wait_for(r"port (\d+)", LIMIT)[1] == "4711"


def test_a_line_counts_also_when_it_came_before():
    with python("import signal; print('one'); print('two', flush=True); signal.pause()") as program:
        program.wait_for("two", LIMIT)
        assert program.wait_for("one", LIMIT)


def test_a_line_that_does_not_come_in_time_is_an_error_with_what_was_said():
    with python(WAITING) as program:
        program.wait_for("port", LIMIT)
        with pytest.raises(BenchmarkError, match=r"did not say 'ready' within 0.05 s(?s:.*)port 4711"):
            program.wait_for("ready", 0.05)


def test_a_program_that_ends_early_is_an_error_at_once():
    with python("import sys; sys.exit('no such robot')") as program, pytest.raises(
        BenchmarkError, match=r"ended early(?s:.*)no such robot"
    ):
        program.wait_for("ready", LIMIT)


def test_waiting_for_the_end_gives_the_output():
    with python("print('a'); print('b')") as program:
        assert program.wait(LIMIT) == "a\nb"


def test_a_status_other_than_zero_is_an_error():
    with python("import sys; print('broken'); sys.exit(3)") as program, pytest.raises(
        BenchmarkError, match=r"ended with status 3(?s:.*)broken"
    ):
        program.wait(LIMIT)


def test_a_program_that_does_not_end_is_an_error():
    with python(WAITING) as program, pytest.raises(BenchmarkError, match="did not end within 0.05 s"):
        program.wait(0.05)


def test_the_environment_is_added_to():
    with python("import os; print(os.environ['COLOUR'], 'PATH' in os.environ)", COLOUR="green") as program:
        assert program.wait(LIMIT) == "green True"


def test_leaving_the_block_interrupts_it_so_that_it_can_clean_up():
    text = (
        "import signal\n"
        "try:\n    print('up', flush=True); signal.pause()\n"
        "except KeyboardInterrupt:\n    print('cleaned up', flush=True)"
    )
    with python(text) as program:
        program.wait_for("up", LIMIT)
    assert "cleaned up" in program.output
    assert not alive(program.pid)


def test_what_it_started_ends_with_it():
    text = (
        "import subprocess, sys\n"
        f"child = subprocess.Popen([sys.executable, '-c', {DEAF!r}])\n"
        "print('child', child.pid, flush=True)\n"
        "try:\n    child.wait()\n"
        "except KeyboardInterrupt:\n    pass"
    )
    with python(text) as program:
        pid = int(program.wait_for(r"child (\d+)", LIMIT)[1])
        program.wait_for("deaf", LIMIT)
        # A descriptor of the process tells its end, whoever is its parent by then.
        descriptor = os.pidfd_open(pid) if hasattr(os, "pidfd_open") else None
    if descriptor is None:
        pytest.skip("this Python cannot wait for a process that is not its child")
    try:
        assert select.select([descriptor], [], [], LIMIT)[0], "the child is still running"
    finally:
        os.close(descriptor)


def test_a_program_that_ended_by_itself_can_be_stopped():
    program = python("print('done')")
    program.wait(LIMIT)
    program.stop()
    assert program.output == "done"


def test_ctrl_c_at_our_terminal_is_not_for_it():
    """It is in a session of its own, so signals to our group do not reach it."""
    with python(WAITING) as program:
        program.wait_for("port", LIMIT)
        assert os.getsid(program.pid) == program.pid != os.getsid(0)


def test_a_program_that_ignores_interrupts_is_killed(monkeypatch):
    monkeypatch.setattr("nao_benchmarks.program.PATIENCE", 0.2)
    with python(DEAF) as program:
        program.wait_for("deaf", LIMIT)
    assert program._process.returncode == -signal.SIGKILL


def test_a_program_that_is_not_there_is_reported():
    with pytest.raises(FileNotFoundError):
        Program("nothing", ["/no/such/program"])


def test_it_is_started_without_a_shell():
    with Program("echo", ["echo", "$HOME; ls"]) as program:
        assert program.wait(LIMIT) == "$HOME; ls"
