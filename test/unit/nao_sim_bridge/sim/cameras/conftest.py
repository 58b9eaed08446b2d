"""The cameras of a robot without physics: time passes when a test says so, and pictures are plain."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import numpy as np
import pytest

from nao_sim_bridge.sim.cameras.cameras import Cameras
from nao_sim_bridge.sim.cameras.photograph import photograph
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.render.scene import RenderState

TICK = 1.0 / 120.0
GREY = (120, 120, 120)
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


class PlainPictures:
    """Draws a picture of one colour.

    Attributes:
        color: Of the picture.
        shots: What was asked for.
        free: Cleared to let drawing wait.
        error: Raised instead of a picture.
    """

    def __init__(self):
        self.color = GREY
        self.shots = []
        self.free = threading.Event()
        self.free.set()
        self.error = None

    def capture(self, state, shot, timeout=10.0):
        self.free.wait(timeout)
        self.shots.append(shot)
        if self.error is not None:
            raise self.error
        return photograph(np.full((shot.height, shot.width, 3), self.color, np.uint8), shot)

    def close(self):
        pass


class Head:
    """Cameras of a robot that stands at the origin, unless a test moves it."""

    def __init__(self, version="V6", tick_s=TICK, patience=10.0):
        self.model = load_model(version)
        self.pictures = PlainPictures()
        self.positions = posture(self.model, "Stand")
        self.patience = patience
        self.tick_s = tick_s
        self.released = threading.Event()
        self.cameras = Cameras(self.model, tick_s, self.pictures, self._look, released=self.released.set)
        self.tick = 0
        self.cameras.begin(self.snapshot())

    def snapshot(self):
        pose = Pose((0.0, 0.0, 0.33), UPRIGHT)
        return SimpleNamespace(
            tick=self.tick, time=self.tick * self.tick_s, torso=pose, odometry=pose, positions=self.positions
        )

    def run(self, ticks=1):
        for _ in range(ticks):
            self.tick += 1
            self.cameras.tick(self.snapshot())

    def open(self, camera=0, resolution=1, color_space=11, fps=30, **options):
        return self.cameras.open("test", camera, resolution, color_space, fps, **options)

    def take(self, stream):
        return stream.take(self.patience)

    def times(self, stream, ticks):
        """Ticks at which frames of a stream fall due in the next `ticks`."""
        found = []
        for _ in range(ticks):
            self.run()
            if stream._pending:
                found.append(round(self.take(stream).time / self.tick_s))
        return found

    @staticmethod
    def _look(snapshot):
        return RenderState(snapshot.torso.position, snapshot.torso.orientation, snapshot.positions, (0.0,) * 89)


@pytest.fixture
def head_of():
    """Makes cameras; they are closed after the test."""
    made = []

    def make(**options):
        made.append(Head(**options))
        return made[-1]

    yield make
    for head in made:
        head.pictures.free.set()
        head.cameras.close()


@pytest.fixture
def head(head_of):
    return head_of()
