"""Cameras of no robot: each frame shows its number, and time passes when a test says so."""

from __future__ import annotations

import threading
from collections import deque

import numpy as np

from nao_sim_bridge.sim.cameras.frame import Frame
from nao_sim_bridge.sim.cameras.stream import CameraClosed

SIZES = {0: (160, 120), 1: (320, 240), 2: (640, 480), 3: (1280, 960), 7: (80, 60), 8: (40, 30)}
FIELD = (0.9826, 0.7627)


def plain(number, shape):
    """A picture whose grey, everywhere, is ten times the number of the frame."""
    return np.full(shape, (10 * number) % 250, np.uint8)


class FakeCameras:
    """Streams of pictures; `opened` has all of them."""

    def __init__(self, paint=plain):
        self.paint = paint
        self.time = 0.0
        self.opened = []

    def open(self, name, camera, resolution, color_space, fps, every=False):
        stream = FakeStream(self, name, camera, resolution, color_space, fps, every)
        self.opened.append(stream)
        stream.due(self.time)
        return stream

    @property
    def open_streams(self):
        return [stream for stream in self.opened if not stream.closed]

    def advance(self, seconds):
        end = self.time + seconds
        for stream in self.opened:
            stream.pass_time(end)
        self.time = end


class FakeStream:
    def __init__(self, cameras, name, camera, resolution, color_space, fps, every):
        self.name, self.camera, self.resolution, self.color_space = name, camera, resolution, color_space
        self.fps, self.every = fps, every
        self.closed = self.finished = False
        self.lost = 0
        self._cameras = cameras
        self._news = threading.Condition()
        self._frames = deque()
        self._number = 0
        self._begun = cameras.time

    def pass_time(self, end):
        while not (self.closed or self.finished) and self._begun + self._number / self.fps <= end + 1e-9:
            self.due(self._begun + self._number / self.fps)

    def due(self, time):
        number, self._number = self._number, self._number + 1
        if number in getattr(self._cameras, "losing", ()):
            return
        with self._news:
            if not self.every:
                self._frames.clear()
            self._frames.append((number, time))
            self._news.notify_all()

    def take(self, timeout):
        with self._news:
            there = self._news.wait_for(lambda: self._frames or self.closed or self.finished, timeout)
            if self.closed or (self.finished and not self._frames):
                raise CameraClosed("closed")
            if not there:
                raise TimeoutError("no frame")
            number, time = self._frames.popleft()
        width, height = SIZES[self.resolution]
        layers = 1 if self.color_space == 0 else 3
        shape = (height, width) if layers == 1 else (height, width, layers)
        data = self._cameras.paint(number, shape).tobytes()
        place = (0.05, 0.0, 0.17, 0.0, 0.0, 0.0)
        robot = (0.05, 0.0, 0.5, 0.0, 0.0, 0.0)
        return Frame(time, self.camera, width, height, self.color_space, layers, data, *FIELD, place, robot, number)

    def finish(self):
        with self._news:
            self.finished = True
            self._news.notify_all()

    def close(self):
        with self._news:
            self.closed = True
            self._news.notify_all()
