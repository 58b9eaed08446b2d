"""Pictures of camera messages: every encoding, sizes, files, and what is no picture."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from camera_topics import compressed, image
from sensor_msgs.msg import Image

from nao_library_modules.vision.pictures import (
    BadPicture,
    encoded,
    encoding_of,
    fitted,
    picture_of,
    scaled,
    visible,
    wanted_size,
)

ORANGE = (0, 128, 255)  # blue, green, red


def test_colours_are_those_of_the_message():
    for encoding, pixel, colour in (
        ("bgr8", ORANGE, ORANGE), ("rgb8", ORANGE[::-1], ORANGE), ("bgra8", (*ORANGE, 7), ORANGE),
        ("rgba8", (*ORANGE[::-1], 7), ORANGE), ("mono8", (90,), (90, 90, 90)), ("8UC3", ORANGE, ORANGE),
        ("8UC1", (90,), (90, 90, 90)),
    ):  # fmt: skip
        picture = picture_of(image(0.0, pixel, (6, 4), encoding))
        assert picture.shape == (4, 6, 3) and (picture == colour).all(), encoding


def test_pairs_of_pixels_share_their_colour():
    y, u, v = 150, 90, 200
    # ITU-R BT.601, luma 16..235.
    luma = 1.164 * (y - 16)
    red = min(luma + 1.596 * (v - 128), 255.0)
    green, blue = luma - 0.813 * (v - 128) - 0.391 * (u - 128), luma + 2.018 * (u - 128)
    for encoding, order in (("yuv422", "UYVY"), ("yuv422_yuy2", "YUYV")):
        data = bytes({"Y": y, "U": u, "V": v}[letter] for letter in order) * 6
        picture = picture_of(Image(width=4, height=3, step=8, encoding=encoding, data=data))
        assert picture.shape == (3, 4, 3)
        assert np.abs(picture.astype(float) - [blue, green, red]).max() <= 2.0


def test_bayer_patterns_are_told_by_their_first_row():
    for encoding, (x, y) in (("rggb", (0, 0)), ("bggr", (1, 1)), ("gbrg", (0, 1)), ("grbg", (1, 0))):
        rows = np.zeros((8, 8), np.uint8)
        rows[y::2, x::2] = 200  # only red pixels see light
        message = Image(width=8, height=8, step=8, encoding=f"bayer_{encoding}8", data=rows.tobytes())
        inner = picture_of(message)[2:-2, 2:-2]
        assert (inner[..., 2] == 200).all() and not inner[..., :2].any(), encoding


@pytest.mark.parametrize("big", [False, True])
def test_sixteen_bits_of_grey_stay(big):
    values = np.array([[256, 513], [65535, 0]], ">u2" if big else "<u2")
    message = Image(width=2, height=2, step=4, encoding="mono16", is_bigendian=big, data=values.tobytes())
    picture = picture_of(message)
    assert picture.dtype == np.uint16 and picture.tolist() == [[256, 513], [65535, 0]]
    assert visible(picture)[:, :, 1].tolist() == [[1, 2], [255, 0]]
    back = cv2.imdecode(np.frombuffer(encoded(picture, "png"), np.uint8), cv2.IMREAD_UNCHANGED)
    assert back.tolist() == picture.tolist()


def test_compressed_messages_are_pictures_as_well():
    for kind in ("png", "jpg"):
        data = encoded(picture_of(image(0.0, ORANGE)), kind)
        picture = picture_of(compressed(0.0, data, f"bgr8; {kind} compressed bgr8"))
        assert picture.shape == (48, 64, 3) and np.abs(picture.astype(int) - ORANGE).max() <= 3
    for text, encoding in (("jpeg", "jpeg"), ("rgb8; jpeg compressed bgr8", "jpeg"), ("png", "png"), ("", "jpeg")):
        assert encoding_of(compressed(0.0, b"", text)) == encoding


def test_what_is_no_picture_is_told():
    for message, problem in (
        (image(0.0, encoding="32FC1"), "'32FC1' cannot be read: known are bgr8, rgb8"),
        (Image(width=4, height=4, step=12, encoding="bgr8", data=b"12"), "4x4 pixels need 48, there are 2 bytes"),
        (Image(width=4, height=4, step=3, encoding="bgr8", data=bytes(48)), "in rows of 3"),
        (Image(width=0, height=4, encoding="bgr8"), "it is 0x4 pixels"),
        (Image(width=3, height=1, step=6, encoding="yuv422", data=bytes(6)), "3 pixels a row are no pairs"),
        (compressed(0.0, b"no picture"), "'jpeg' cannot be read: its 10 bytes are no compressed picture"),
    ):
        with pytest.raises(BadPicture, match=problem):
            picture_of(message)


def test_sizes_and_pictures_that_are_made_to_fit():
    for wanted, size in (((0, 0), (64, 48)), ((32, 0), (32, 24)), ((0, 12), (16, 12)), ((100, 10), (100, 10))):
        assert wanted_size((64, 48), *wanted) == size
        assert scaled(picture_of(image(0.0)), *wanted).shape == (size[1], size[0], 3)
    white = np.full((10, 10, 3), 255, np.uint8)
    frame = fitted(white, 40, 20)
    assert frame.shape == (20, 40, 3), "it keeps its proportions"
    assert (frame[:, 10:30] == 255).all() and not frame[:, :10].any() and not frame[:, 30:].any()
    assert fitted(white, 10, 10) is white


def test_every_kind_of_file_can_be_read_and_quality_tells_how_much_is_kept():
    picture = picture_of(image(0.0, ORANGE))
    for kind in ("png", "jpg", "bmp", "tiff", "webp"):
        back = cv2.imdecode(np.frombuffer(encoded(picture, kind), np.uint8), cv2.IMREAD_COLOR)
        assert back.shape == picture.shape
        assert np.abs(back.astype(int) - picture).max() <= (0 if kind in ("png", "bmp", "tiff") else 4)
    noise = np.random.default_rng(1).integers(0, 255, (48, 64, 3), dtype=np.uint8)
    sizes = [len(encoded(noise, "jpg", quality)) for quality in (5, 50, 0, 100)]
    assert sizes == sorted(sizes) and len(set(sizes)) == 4
