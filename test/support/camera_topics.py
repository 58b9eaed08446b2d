"""Cameras on topics without ROS: the test sends the frames. Pictures tell their numbers."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import cv2
import numpy as np
from genpy import Time
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from nao_library_modules.vision.pictures import picture_of
from naoqi.errors import NaoError

CAMERA, OUT = "/camera/image_raw", "/out/image_raw"
TOP, BOTTOM = "/nao_robot/camera/top/image_raw", "/nao_robot/camera/bottom/image_raw"
LIMIT = 60.0


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


class Publisher:
    """Keeps what is published.

    Attributes:
        before: Called before each message, in the thread that publishes.
    """

    def __init__(self, kind):
        self.kind = kind
        self.messages = []
        self.heard = True
        self.closed = False
        self.before = lambda: None

    def publish(self, message):
        assert not self.closed
        self.before()
        self.messages.append(message)

    def is_heard(self):
        return self.heard

    def close(self):
        self.closed = True


class Topics:
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
        self.publishers[topic] = Publisher(kind)
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


class HandClock:
    """ROS time that the test sets.

    Attributes:
        on_now: Called whenever somebody asks for the time.
    """

    def __init__(self):
        self.time = 50.0
        self.on_now = lambda: None

    def now(self):
        self.on_now()
        return self.time


def numbers_of(messages):
    return [number_of(picture_of(message)) for message in messages]


def read_video(path):
    """Numbers of the frames of a video."""
    capture, found = cv2.VideoCapture(str(path)), []
    while True:
        there, picture = capture.read()
        if not there:
            return found
        found.append(number_of(picture))
