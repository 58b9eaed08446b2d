"""Cameras on topics without ROS: the test sends the frames; and the robot's ALVideoDevice."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import numpy as np
from genpy import Time
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from nao_library_msgs.msg import VisionFunction
from naoqi.errors import NaoError, RobotError

TOP, BOTTOM = "/nao_robot/camera/top/image_raw", "/nao_robot/camera/bottom/image_raw"
LIMIT = 10.0


def f(function, **fields):
    return VisionFunction(function=function, **fields)


def header(stamp, frame="CameraTop_optical_frame"):
    return Header(stamp=Time.from_sec(stamp), frame_id=frame)


def image(stamp, colour=(0, 0, 255), size=(64, 48), encoding="bgr8"):
    """A picture of one colour (blue, green, red), or of bytes."""
    width, height = size
    data = bytes(colour) * (width * height)
    return Image(
        header=header(stamp), width=width, height=height, encoding=encoding, step=len(data) // height, data=data
    )


def numbered(number, size=(64, 48)):
    """A picture that tells a number below 256, also after compression: eight bars, white where a bit is set."""
    bits = [(number >> bit) & 1 for bit in range(8)]
    row = np.repeat(np.array(bits, np.uint8) * 255, size[0] // 8)
    return np.ascontiguousarray(np.broadcast_to(row[None, :, None], (size[1], len(row), 3)))


def number_of(picture):
    """What number a picture tells."""
    bars = np.array_split(np.asarray(picture, float).reshape(*picture.shape[:2], -1).mean(axis=(0, 2)), 8)
    return sum(int(bar.mean() > 127.0) << bit for bit, bar in enumerate(bars))


def numbered_image(number, stamp, size=(64, 48)):
    data = numbered(number, size).tobytes()
    return Image(header=header(stamp), width=size[0], height=size[1], encoding="bgr8", step=3 * size[0], data=data)


def compressed(stamp, data, kind="jpeg"):
    return CompressedImage(header=header(stamp), format=kind, data=data)


def wait_for(condition, what="it"):
    """Wait until a condition holds that threads bring about."""
    end = time.monotonic() + LIMIT
    while not condition():
        assert time.monotonic() < end, f"{what} does not come"
        threading.Event().wait(0.002)


class FakePublisher:
    """Keeps what is published."""

    def __init__(self, kind):
        self.kind = kind
        self.messages = []
        self.heard = True
        self.closed = False

    def publish(self, message):
        assert not self.closed
        self.messages.append(message)

    def is_heard(self):
        return self.heard

    def close(self):
        self.closed = True


class FakeTopics:
    """Topics of cameras.

    Attributes:
        subscribers: Topic -> functions that take messages.
        publishers: Topic -> its latest publisher.
        servers: dynamic_reconfigure: server -> its settings.
        on_subscribe: Called with a topic when somebody subscribes to it.
    """

    def __init__(self):
        self._lock = threading.Lock()
        self.subscribers = {}
        self.publishers = {}
        self.servers = {}
        self.on_subscribe = lambda topic: None

    def resolved(self, topic):
        return topic if topic.startswith("/") else f"/{topic}"

    def subscribe(self, topic, take):
        with self._lock:
            self.subscribers.setdefault(topic, []).append(take)

        def close():
            with self._lock:
                if take in self.subscribers[topic]:
                    self.subscribers[topic].remove(take)

        self.on_subscribe(topic)
        return SimpleNamespace(close=close)

    subscribe_info = subscribe

    def send(self, topic, message):
        with self._lock:
            takers = list(self.subscribers.get(topic, []))
        for take in takers:
            take(message)

    def count(self, topic):
        with self._lock:
            return len(self.subscribers.get(topic, []))

    def publisher(self, topic, kind):
        self.publishers[topic] = FakePublisher(kind)
        return self.publishers[topic]

    def settings(self, server):
        if server not in self.servers:
            raise NaoError(f"no service {server}/set_parameters")
        return dict(self.servers[server])

    def set(self, server, values):
        self.settings(server)
        assert all(type(value) is type(self.servers[server][name]) for name, value in values.items())
        self.servers[server].update(values)
        return dict(self.servers[server])


class FakeVideoDevice:
    """ALVideoDevice with a few parameters."""

    RANGES = {0: [-255, 255, 0], 1: [0, 255, 32], 11: [0, 1, 1], 12: [0, 1, 1]}

    def __init__(self):
        self.active = 0
        self.values = {camera: {number: row[2] for number, row in self.RANGES.items()} for camera in (0, 1)}

    def setActiveCamera(self, camera):
        self.active = camera
        return True

    def _row(self, method, number):
        if number not in self.RANGES:
            raise RobotError("ALVideoDevice", method, f"no parameter {number}")
        return self.RANGES[number]

    def getParameter(self, camera, number):
        self._row("getParameter", number)
        return self.values[camera][number]

    def getParameterRange(self, camera, number):
        return self._row("getParameterRange", number)

    def setParameter(self, camera, number, value):
        lowest, highest, _ = self._row("setParameter", number)
        if not lowest <= value <= highest:
            return False
        self.values[camera][number] = value
        return True

    def setAllParametersToDefault(self, camera):
        self.values[camera] = {number: row[2] for number, row in self.RANGES.items()}
        return True
