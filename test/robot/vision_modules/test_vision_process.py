"""The vision process: detectors at work in it, what they remember, and what happens when it dies."""

from __future__ import annotations

import logging
import os
import signal

import numpy as np
import pytest
from seen_cards import OPTICS, mark, sphere

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.vision.ball import BallDetector
from nao_sim_bridge.vision.client import VisionClosed, VisionProcess, VisionRefused
from nao_sim_bridge.vision.worker import DETECTORS, make_detector

BALL = sphere(0.8, 0.05, 0.1, 0.05)


@pytest.fixture
def process():
    process = VisionProcess()
    assert process.detector("ball") and process.pid is None, "there is no process before there is work"
    yield process
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
    process.close()
    with pytest.raises(VisionClosed, match="^ball: the vision process is closed$"):
        ball.detect(BALL, OPTICS)
