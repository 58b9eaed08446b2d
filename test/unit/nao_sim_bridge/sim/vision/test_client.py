"""The vision process: detectors at work in it, what they remember, and what happens when it dies."""

from __future__ import annotations

import logging
import os
import signal
import threading

import numpy as np
import pytest
from seen_cards import OPTICS, mark, sphere

from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.vision import client
from nao_sim_bridge.sim.vision.ball import BallDetector
from nao_sim_bridge.sim.vision.client import VisionClosed, VisionError, VisionProcess, VisionRefused
from nao_sim_bridge.sim.vision.detector import DETECTORS, make_detector

DYING = """
import os, sys
from nao_sim_bridge.sim.child_process import pipe_to_parent
pipe = pipe_to_parent(sys.argv[1])
pipe.send(("ready", None))
while True:
    kind, content = pipe.recv()
    if kind == "call" and content[1] == "detect":
        os._exit(3)
    pipe.send((kind, content))
"""


@pytest.fixture(scope="module")
def shared_process():
    process = VisionProcess()
    yield process
    process.close()


@pytest.fixture
def process(shared_process):
    """The process of this file; what a test does to it, it does to the next one too, which starts another."""
    return shared_process


@pytest.fixture
def dying(tmp_path, monkeypatch):
    """A process that ends whenever something is to be detected."""
    (tmp_path / "dying_vision.py").write_text(DYING)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(client, "MODULE", "dying_vision")
    process = VisionProcess()
    yield process
    process.close()


def warnings(caplog):
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]


def test_there_is_no_process_before_there_is_work():
    process = VisionProcess()
    assert process.detector("ball") and process.pid is None
    process.close()


def test_it_finds_what_the_detector_finds(process):
    picture = sphere(0.8, 0.05, 0.1, 0.05)
    assert process.detector("ball").detect(picture, OPTICS) == BallDetector().detect(picture, OPTICS)


def test_several_detectors_share_one_process(process):
    ball, marks, codes = (process.detector(name) for name in ("ball", "landmarks", "barcodes"))
    pids = set()
    picture = mark(85, 0.7)
    assert ball.detect(picture, OPTICS) == []
    pids.add(process.pid)
    assert [seen.number for seen in marks.detect(picture, OPTICS)] == [85]
    pids.add(process.pid)
    assert codes.detect(picture, OPTICS) == []
    pids.add(process.pid)
    assert len(pids) == 1


def test_a_detector_that_fails_says_where_and_the_process_goes_on(process):
    ball = process.detector("ball")
    with pytest.raises(VisionRefused, match="^ball: Traceback"):
        ball.detect(np.zeros((2, 2), np.uint8), OPTICS)
    pid = process.pid
    assert len(ball.detect(sphere(0.8, 0.05), OPTICS)) == 1
    assert process.pid == pid


def test_an_unknown_detector_is_refused(process):
    with pytest.raises(VisionRefused, match="unknown detector 'bal': did you mean 'ball'"):
        process.detector("bal").detect(sphere(0.8, 0.05), OPTICS)
    with pytest.raises(UnknownName):
        make_detector("bal")


@pytest.mark.parametrize("name", ["ball", "landmarks", "barcodes"])
def test_detectors_can_be_made_by_their_names(name):
    assert type(make_detector(name)).__name__ == DETECTORS[name].rpartition(".")[2]


def test_a_dead_process_is_started_again_with_one_warning_and_nothing_is_lost(process, caplog):
    ball, marks = process.detector("ball"), process.detector("landmarks")
    picture = sphere(0.8, 0.05)
    before = ball.detect(picture, OPTICS)
    marks.detect(picture, OPTICS)
    dead = process.pid
    os.kill(dead, signal.SIGKILL)
    assert ball.detect(picture, OPTICS) == before
    assert [seen.number for seen in marks.detect(mark(85, 0.7), OPTICS)] == [85]
    assert process.pid != dead
    assert warnings(caplog) == ["ball: the vision process ended with status -9; it is started again"]


def test_a_detector_gets_its_arguments_again_in_a_new_process(process):
    asked = []

    def arguments():
        asked.append(len(asked))
        return ()

    ball = process.detector("ball", arguments)
    picture = sphere(0.8, 0.05)
    ball.detect(picture, OPTICS)
    ball.detect(picture, OPTICS)
    assert asked == [0]
    os.kill(process.pid, signal.SIGKILL)
    ball.detect(picture, OPTICS)
    assert asked == [0, 1]
    ball.close()
    ball.detect(picture, OPTICS)
    assert asked == [0, 1, 2]


def test_work_that_ends_the_process_is_given_up(dying, caplog):
    ball = dying.detector("ball")
    picture = sphere(0.8, 0.05)
    with pytest.raises(VisionError, match="^ball: the vision process ended with status 3$"):
        ball.detect(picture, OPTICS)
    assert len(warnings(caplog)) == 1
    with pytest.raises(VisionError, match="ended with status 3"):
        ball.detect(picture, OPTICS)
    with pytest.raises(VisionError, match="^ball: ended the vision process 4 times$"):
        ball.detect(picture, OPTICS)
    assert dying.pid is None
    assert dying.detector("landmarks").call("other") == (2, "other", ())  # another one is not to blame


def test_closed_it_answers_nothing_and_the_process_ends():
    process = VisionProcess()
    ball = process.detector("ball")
    ball.detect(sphere(0.8, 0.05), OPTICS)
    pid = process.pid
    process.close()
    with pytest.raises(VisionClosed, match="^ball: the vision process is closed$"):
        ball.detect(sphere(0.8, 0.05), OPTICS)
    ball.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_who_waits_for_a_hanging_process_hears_of_the_end(tmp_path, monkeypatch, patience):
    hanging = DYING.replace("os._exit(3)", "threading.Event().wait()").replace("import os,", "import threading,")
    (tmp_path / "hanging_vision.py").write_text(hanging)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(client, "MODULE", "hanging_vision")
    monkeypatch.setattr(client, "CLOSING", 0.05)
    process = VisionProcess()
    errors = []

    def work():
        try:
            process.detector("ball").detect(sphere(0.8, 0.05), OPTICS)
        except VisionClosed as error:
            errors.append(error)

    waiting = threading.Thread(target=work)
    waiting.start()
    while process.pid is None and waiting.is_alive():
        waiting.join(0.01)
    process.close()
    waiting.join(patience)
    assert not waiting.is_alive()
    assert len(errors) == 1
