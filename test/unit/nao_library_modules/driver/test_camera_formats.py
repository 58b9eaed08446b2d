"""Answers of getImageRemote become pictures with the encoding that their colours have in ROS."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.camera_formats import COLOR_SPACES, SIZES, read_picture
from naoqi.errors import NaoError

EDGES = [0.49, 0.38, -0.49, -0.38]


def image(space, width, height, layers, pixels, camera=0):
    return [width, height, layers, space, 7, 250000, pixels, camera, *EDGES]


@pytest.mark.parametrize(
    "space, encoding, layers",
    [(13, "bgr8", 3), (11, "rgb8", 3), (0, "mono8", 1), (10, "8UC3", 3), (6, "8UC1", 1)],
)
def test_colour_spaces_are_encodings(space, encoding, layers):
    pixels = bytes(range(24 * layers))
    picture = read_picture(image(space, 6, 4, layers, pixels, camera=1), 0)
    assert (picture.encoding, picture.step, picture.camera) == (encoding, 6 * layers, 1)
    assert (picture.width, picture.height, picture.time) == (6, 4, 7.25)
    assert picture.pixels is pixels


def test_yuv422_of_ros_has_colour_before_brightness():
    picture = read_picture(image(9, 2, 2, 2, b"YUyVZWzX"), 0)
    assert (picture.encoding, picture.step, picture.pixels) == ("yuv422", 4, b"UYVyWZXz")


def test_an_answer_without_the_camera_is_of_the_one_that_was_asked():
    assert read_picture(image(0, 2, 1, 1, b"ab")[:7], 1).camera == 1


@pytest.mark.parametrize(
    "answer, text",
    [
        (None, "no picture but None"),
        ([1, 2, 3], "no picture but"),
        (image(17, 2, 1, 2, b"abcd"), "colour space 17"),
        (image(13, 2, 2, 3, bytes(11)), "2x2 in bgr8 has 11 bytes, not 12"),
        (image(13, 2, 2, 3, "bytearray(b'')"), "has str, not 12 bytes"),
    ],
)
def test_what_is_no_picture_is_told(answer, text):
    with pytest.raises(NaoError, match=text):
        read_picture(answer, 0)


def test_tables_have_the_numbers_of_naoqi():
    assert SIZES[1] == (320, 240) and SIZES[2] == (640, 480) and SIZES[0] == (160, 120)
    assert COLOR_SPACES[13] == "BGR, encoding bgr8"
    assert 14 not in COLOR_SPACES and 17 not in COLOR_SPACES
