"""A module in a process of its own: its answers, its errors, its end."""

from __future__ import annotations

import os
import signal

import pytest

from nao_sim_bridge.sim.child_process import ChildProcess, error_text
from nao_sim_bridge.sim.errors import SimulationError


class Failed(SimulationError):
    """The process is not well."""


class Refused(SimulationError):
    """It cannot do this."""


CHILD = """
import os, sys
from nao_sim_bridge.sim.child_process import pipe_to_parent
pipe = pipe_to_parent(sys.argv[1])
pipe.send(("ready", sys.argv[2:]))
while True:
    try:
        kind, content = pipe.recv()
    except EOFError:
        break
    if kind == "leave":
        os._exit(content)
    pipe.send(("error", f"cannot {content}") if kind == "refuse" else (kind, content))
"""


@pytest.fixture
def child(tmp_path, monkeypatch):
    """A process that answers with what it is asked, and has started."""
    (tmp_path / "some_child.py").write_text(CHILD)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    started = ChildProcess("some_child", ["one", "two"], "test process", Failed, Refused)
    assert started.receive(30.0, "start") == ["one", "two"]
    yield started
    if started.process.poll() is None:
        started.kill()


def test_it_answers_refuses_hears_no_interrupt_of_a_terminal_and_ends_with_its_pipe(child):
    assert child.ask("say", {"a": 1}, 30.0, "question") == {"a": 1}
    with pytest.raises(Refused, match="^lifting: cannot lift$"):
        child.ask("refuse", "lift", 30.0, "lifting")
    child.process.send_signal(signal.SIGINT)
    assert child.ask("say", 2, 30.0, "question") == 2
    child.stop()
    assert child.process.returncode == 0


def test_its_end_is_told_with_its_status(child):
    with pytest.raises(Failed, match="^leaving: the test process ended with status 7$"):
        child.ask("leave", 7, 30.0, "leaving")
    with pytest.raises(Failed, match="ended with status 7"):
        child.ask("say", 1, 30.0, "more")


def test_no_answer_is_an_error_and_it_can_be_killed(child):
    child.process.send_signal(signal.SIGSTOP)
    with pytest.raises(Failed, match=r"question: no answer of the test process within 0\.05 s"):
        child.ask("say", 1, 0.05, "question")
    child.kill()
    assert child.process.returncode == -signal.SIGKILL
    with pytest.raises(ProcessLookupError):
        os.kill(child.process.pid, 0)


def test_errors_of_ours_are_their_text_and_others_tell_where_they_come_from():
    assert error_text(Refused("not this")) == "not this"
    try:
        raise ValueError("a slip")
    except ValueError as error:
        assert "Traceback" in error_text(error) and "a slip" in error_text(error)
