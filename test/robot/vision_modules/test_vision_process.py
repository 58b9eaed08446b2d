"""The vision process: detectors at work in it, what they remember, and what happens when it dies."""

from __future__ import annotations

import logging
import os
import queue
import signal
import threading

import numpy as np
import pytest
from seen_cards import OPTICS, mark, sphere
from simulator import PATIENCE

from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.vision import client
from nao_sim_bridge.sim.vision.ball import BallDetector
from nao_sim_bridge.sim.vision.client import VisionClosed, VisionError, VisionProcess, VisionRefused
from nao_sim_bridge.sim.vision.detector import DETECTORS, make_detector

DYING = """
import os, sys, threading
from nao_sim_bridge.sim.child_process import pipe_to_parent
pipe = pipe_to_parent(sys.argv[1])
pipe.send(("ready", None))
while True:
    kind, content = pipe.recv()
    if kind == "call" and content[1] == "detect":
        END
    pipe.send((kind, content))
"""
BALL = sphere(0.8, 0.05, 0.1, 0.05)


@pytest.fixture(scope="module")
def process():
    process = VisionProcess()
    assert process.detector("ball") and process.pid is None, "there is no process before there is work"
    yield process
    process.close()


@pytest.fixture
def ending(tmp_path, monkeypatch):
    """Makes a process that does something else when it is to detect."""
    made = []

    def make(end):
        (tmp_path / "ending_vision.py").write_text(DYING.replace("END", end))
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        monkeypatch.setattr(client, "MODULE", "ending_vision")
        made.append(VisionProcess())
        return made[-1]

    yield make
    for process in made:
        process.close()


def warnings(caplog):
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]


def test_several_detectors_share_one_process_and_one_that_fails_says_where(process):
    ball, marks, codes = (process.detector(name) for name in ("ball", "landmarks", "barcodes"))
    assert ball.detect(BALL, OPTICS) == BallDetector().detect(BALL, OPTICS)
    pid = process.pid
    assert [seen.number for seen in marks.detect(mark(85, 0.7), OPTICS)] == [85]
    assert codes.detect(mark(85, 0.7), OPTICS) == []
    with pytest.raises(VisionRefused, match="^ball: Traceback"):
        ball.detect(np.zeros((2, 2), np.uint8), OPTICS)
    with pytest.raises(VisionRefused, match="unknown detector 'bal': did you mean 'ball'"):
        process.detector("bal").detect(BALL, OPTICS)
    assert len(ball.detect(BALL, OPTICS)) == 1 and process.pid == pid
    with pytest.raises(UnknownName):
        make_detector("bal")
    assert type(make_detector("ball")).__name__ == DETECTORS["ball"].rpartition(".")[2]


def test_a_dead_process_is_started_again_with_one_warning_and_nothing_is_lost(process, caplog):
    asked = []
    ball, marks = process.detector("ball", lambda: asked.append(len(asked)) or ()), process.detector("landmarks")
    before = ball.detect(BALL, OPTICS)
    marks.detect(BALL, OPTICS)
    ball.detect(BALL, OPTICS)
    assert asked == [0]
    dead = process.pid
    os.kill(dead, signal.SIGKILL)
    assert ball.detect(BALL, OPTICS) == before and asked == [0, 1], "it gets its arguments again"
    assert [seen.number for seen in marks.detect(mark(85, 0.7), OPTICS)] == [85]
    assert process.pid != dead
    assert warnings(caplog) == ["ball: the vision process ended with status -9; it is started again"]
    ball.close()
    ball.detect(BALL, OPTICS)
    assert asked == [0, 1, 2]


def test_work_that_ends_the_process_is_given_up(ending, caplog):
    dying = ending("os._exit(3)")
    ball = dying.detector("ball")
    with pytest.raises(VisionError, match="^ball: the vision process ended with status 3$"):
        ball.detect(BALL, OPTICS)
    assert len(warnings(caplog)) == 1
    with pytest.raises(VisionError, match="ended with status 3"):
        ball.detect(BALL, OPTICS)
    with pytest.raises(VisionError, match="^ball: ended the vision process 4 times$"):
        ball.detect(BALL, OPTICS)
    assert dying.pid is None
    assert dying.detector("landmarks").call("other") == (2, "other", ())  # another one is not to blame


def test_who_waits_for_a_process_that_hangs_hears_of_the_end_and_afterwards_it_answers_nothing(ending, monkeypatch):
    monkeypatch.setattr(client, "CLOSING", 0.05)
    process, errors = ending("threading.Event().wait()"), queue.Queue()

    def work():
        try:
            process.detector("ball").detect(BALL, OPTICS)
        except VisionClosed as error:
            errors.put(error)

    waiting = threading.Thread(target=work)
    waiting.start()
    while process.pid is None and waiting.is_alive():
        waiting.join(0.01)
    pid = process.pid
    process.close()
    waiting.join(PATIENCE)
    assert errors.qsize() == 1
    with pytest.raises(VisionClosed, match="^ball: the vision process is closed$"):
        process.detector("ball").detect(BALL, OPTICS)
    process.detector("ball").close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
