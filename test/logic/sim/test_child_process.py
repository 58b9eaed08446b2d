"""A process that works for the simulator has its time, also where others keep the processors."""

from __future__ import annotations

import threading
import time

import pytest

from nao_sim_bridge.base.child_process import ChildProcess, Deadline
from nao_sim_bridge.base.errors import SimulationError

LIMIT = 300.0
ECHO = """\
import sys
from nao_sim_bridge.base.child_process import pipe_to_parent, serve
sys.exit(serve(pipe_to_parent(sys.argv[1]), {"echo": lambda content: content}))
"""


class Failed(SimulationError):
    pass


@pytest.fixture
def child(tmp_path, monkeypatch):
    (tmp_path / "echo_child.py").write_text(ECHO)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    made = ChildProcess("echo_child", [], "echo", Failed, Failed)
    made.ask("echo", None, LIMIT, "start")
    yield made
    made.stop()


def test_time_in_which_a_process_waits_for_a_processor_does_not_count(child, monkeypatch):
    monkeypatch.setattr(Deadline, "_waited", lambda self: time.monotonic())
    answers = threading.Timer(0.1, child.send, ("echo", "here", "echo"))
    answers.start()
    assert child.receive(0.001, "echo") == "here"


def test_a_process_that_had_its_time_and_does_not_answer_is_ended(child):
    with pytest.raises(Failed, match="nothing: no answer of the echo within 0.01 s"):
        child.receive(0.01, "nothing")
    assert child.over and child.late
    assert child.process.poll() is not None


def test_the_system_reports_how_long_a_process_waited(child):
    assert child.deadline(1.0)._waited() > 0.0
