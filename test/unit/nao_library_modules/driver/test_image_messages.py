"""Pictures and calibrations as messages, and calibrations back."""

from __future__ import annotations

import math

import pytest
from sensor_msgs.msg import CameraInfo

from nao_library_modules.driver.camera_calibration import Calibration, ideal
from nao_library_modules.driver.camera_formats import Picture
from nao_library_modules.driver.image_messages import from_info, header_of, to_compressed, to_image, to_info
from naoqi.errors import NaoError

HEADER = header_of(1700000000.0333333, "robot1/CameraTop_optical_frame")
PICTURE = Picture(5.0, 0, 4, 2, "bgr8", bytes(range(24)))
MEASURED = Calibration(
    640,
    480,
    (556.8, 0.0, 309.3, 0.0, 555.9, 230.6, 0.0, 0.0, 1.0),
    (-0.05, 0.07, -0.002, -0.001, 0.0),
    p=(551.6, 0.0, 309.0, 0.0, 0.0, 551.3, 228.7, 0.0, 0.0, 0.0, 1.0, 0.0),
)


def test_headers_tell_times_to_the_microsecond():
    assert (HEADER.stamp.secs, HEADER.stamp.nsecs) == (1700000000, 33333000)
    assert header_of(0.9999999, "").stamp.to_sec() == 1.0
    assert HEADER.frame_id == "robot1/CameraTop_optical_frame"


def test_pixels_are_not_copied():
    message = to_image(PICTURE, HEADER)
    assert message.data is PICTURE.pixels
    assert (message.width, message.height, message.step, message.encoding) == (4, 2, 12, "bgr8")
    assert message.header.stamp == HEADER.stamp


def test_a_file_is_a_compressed_image():
    message = to_compressed("bgr8; png compressed bgr8", b"file", HEADER)
    assert (message.format, message.data, message.header.frame_id) == (
        "bgr8; png compressed bgr8",
        b"file",
        HEADER.frame_id,
    )


def test_a_calibration_is_a_message_and_back():
    info = to_info(MEASURED, Picture(5.0, 0, 640, 480, "mono8", b""), HEADER)
    assert (info.width, info.height, info.distortion_model) == (640, 480, "plumb_bob")
    assert (list(info.K), list(info.P)) == (list(MEASURED.k), list(MEASURED.p))
    assert from_info(info) == MEASURED


def test_without_a_calibration_the_numbers_are_zero_and_that_is_none():
    info = to_info(None, PICTURE, HEADER)
    assert (info.width, info.height, info.K[0], list(info.D)) == (4, 2, 0.0, [])
    with pytest.raises(NaoError, match="focal lengths above 0"):
        from_info(info)


def test_what_a_message_leaves_out_is_that_of_a_plain_camera():
    known = ideal(320, 240, math.radians(56.3), math.radians(43.7))
    found = from_info(CameraInfo(width=320, height=240, K=list(known.k)))
    assert (found.p, found.r, found.model) == (known.p, known.r, "plumb_bob")
