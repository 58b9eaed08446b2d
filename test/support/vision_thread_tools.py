"""What tests of streams and recordings share: a clock by hand, and what is in messages and files."""

from __future__ import annotations

from fake_vision import number_of

from nao_library_modules.vision_pictures import picture_of

CAMERA, OUT = "/camera/image_raw", "/out/image_raw"


class HandClock:
    """ROS time that the test sets."""

    def __init__(self):
        self.time = 50.0

    def now(self):
        return self.time


def numbers(messages):
    return [number_of(picture_of(message)) for message in messages]


def read(path):
    import cv2

    capture = cv2.VideoCapture(str(path))
    found = []
    while True:
        there, picture = capture.read()
        if not there:
            return found
        found.append(number_of(picture))
