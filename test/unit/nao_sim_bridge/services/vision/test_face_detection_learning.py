"""Learning faces with many calls at once; cameras that give no pictures."""

from __future__ import annotations

import threading

import pytest

from nao_sim_bridge.services.vision.face_detection_learning import MOST_WAITING, FaceLearner
from nao_sim_bridge.sim.cameras.stream import CameraClosed
from nao_sim_bridge.sim.errors import BadValue


class NoPictures:
    """A camera and its only stream: who takes a frame waits until all are closed."""

    def __init__(self):
        self.over = threading.Event()

    def open(self, *_, **__):
        return self

    def take(self, timeout):
        if self.over.wait(timeout):
            raise CameraClosed("closed")
        raise TimeoutError

    def close(self):
        pass


class NoDetector:
    def close(self):
        pass


def test_calls_that_wait_are_counted_and_refused_when_they_are_too_many(patience):
    camera = NoPictures()
    learner = FaceLearner(camera, NoDetector(), lambda: 0)
    tasks = [learner.look(lambda _: True) for _ in range(MOST_WAITING)]
    with pytest.raises(BadValue, match=f"calls that learn a face is {MOST_WAITING + 1}, allowed is at most"):
        learner.look(lambda _: True)
    camera.over.set()
    for task in tasks:
        with pytest.raises(RuntimeError, match="the cameras were closed"):
            task.result(patience)
    for thread in threading.enumerate():
        if thread.name == "learn a face":
            thread.join(patience)
    after = learner.look(lambda _: True)  # there is room again
    with pytest.raises(RuntimeError, match="the cameras were closed"):
        after.result(patience)
