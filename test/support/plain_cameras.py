"""The real cameras of a robot without physics: time passes when a test says so, and pictures are plain."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import numpy as np

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.cameras.sensor import photograph
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.world.render_state import RenderState

TICK = 1.0 / 120.0
MANUAL = {11: 0, 12: 0}
"""Parameters for pictures as bright as they are drawn."""


class PlainPictures:
    """Draws pictures: the drawing part of a renderer.

    Attributes:
        paint: Makes a picture of (height, width, 3) from the time, s, and that shape.
    """

    def __init__(self):
        self.paint = lambda time, shape: np.full(shape, 120, np.uint8)

    def capture(self, state, shot, timeout=10.0):
        return photograph(self.paint(state.led_values[0], (shot.height, shot.width, 3)), shot)


class Head:
    """Cameras of a robot that stands at the origin, unless a test moves it."""

    def __init__(self, version="V6", patience=15.0):
        self.model = load_model(version)
        self.pictures = PlainPictures()
        self.positions = posture(self.model, "Stand")
        self.patience = patience
        self.released = threading.Event()
        self.cameras = Cameras(self.model, TICK, self.pictures, self.look, released=self.released.set)
        self.tick = 0
        self.cameras.begin(self.snapshot())

    def snapshot(self):
        pose = Pose((0.0, 0.0, 0.33), (0.0, 0.0, 0.0, 1.0))
        time = self.tick * TICK
        return SimpleNamespace(tick=self.tick, time=time, torso=pose, odometry=pose, positions=self.positions)

    def run(self, ticks=1):
        for _ in range(ticks):
            self.tick += 1
            self.cameras.tick(self.snapshot())

    def advance(self, seconds):
        """Let time pass no faster than those look who want every frame."""
        for _ in range(round(seconds / TICK)):
            self.run()
            self.settle()

    def settle(self):
        """Return when nobody who wants every frame is at work."""
        while True:
            self.released.clear()
            if not self.cameras.holds():
                return
            assert self.released.wait(self.patience), "somebody does not ask for the next frame"

    def open(self, camera=0, resolution=1, color_space=11, fps=30, **options):
        return self.cameras.open("test", camera, resolution, color_space, fps, **options)

    def take(self, stream):
        return stream.take(self.patience)

    def manual(self):
        """Have pictures as bright as they are drawn."""
        for camera in (0, 1):
            for number, value in MANUAL.items():
                self.cameras.set_parameter(camera, number, value)

    def close(self):
        self.cameras.close()

    @staticmethod
    def look(snapshot):
        # The LEDs say which time it is.
        return RenderState(snapshot.torso.position, snapshot.torso.orientation, snapshot.positions, (snapshot.time,))
