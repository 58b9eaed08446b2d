"""Compressed pictures show what the raw ones show."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from nao_library_modules.driver.camera_formats import Picture
from nao_library_modules.driver.image_compression import compress
from naoqi.errors import NaoError

ROWS, COLUMNS = np.mgrid[0:48, 0:64]
SCENE = np.dstack((COLUMNS * 4, ROWS * 5, 255 - COLUMNS * 2 - ROWS)).astype(np.uint8)
"""Blue, green and red that change slowly."""


def picture(encoding, pixels):
    return Picture(0.0, 0, 64, 48, encoding, pixels.tobytes())


@pytest.mark.parametrize("encoding, pixels", [("bgr8", SCENE), ("rgb8", SCENE[..., ::-1])])
def test_png_is_the_same_picture(encoding, pixels):
    kind, file = compress(picture(encoding, pixels), "png", 80, 3)
    assert kind == f"{encoding}; png compressed bgr8"
    np.testing.assert_array_equal(cv2.imdecode(np.frombuffer(file, np.uint8), cv2.IMREAD_UNCHANGED), SCENE)


def test_jpeg_looks_the_same_and_quality_costs_bytes():
    sizes = []
    for quality in (95, 30):
        kind, file = compress(picture("bgr8", SCENE), "jpeg", quality, 3)
        assert kind == "bgr8; jpeg compressed bgr8"
        decoded = cv2.imdecode(np.frombuffer(file, np.uint8), cv2.IMREAD_COLOR)
        assert np.abs(decoded.astype(int) - SCENE).mean() < 6.0
        sizes.append(len(file))
    assert sizes[1] < sizes[0] < SCENE.nbytes


def test_grey_stays_grey():
    kind, file = compress(picture("mono8", SCENE[..., 0]), "png", 80, 3)
    assert kind == "mono8; png compressed "
    np.testing.assert_array_equal(cv2.imdecode(np.frombuffer(file, np.uint8), cv2.IMREAD_UNCHANGED), SCENE[..., 0])


def test_yuv422_keeps_its_colours():
    yuv = cv2.cvtColor(SCENE, cv2.COLOR_BGR2YUV).astype(np.uint8)
    packed = np.empty((48, 64, 2), np.uint8)
    packed[..., 1] = yuv[..., 0]
    packed[:, 0::2, 0], packed[:, 1::2, 0] = yuv[:, 0::2, 1], yuv[:, 0::2, 2]
    _, file = compress(picture("yuv422", packed), "png", 80, 3)
    decoded = cv2.imdecode(np.frombuffer(file, np.uint8), cv2.IMREAD_COLOR)
    assert np.abs(decoded.astype(int) - SCENE).mean() < 20.0


def test_what_is_neither_colour_nor_grey_is_told():
    with pytest.raises(NaoError, match="not 8UC3: choose another color_space"):
        compress(picture("8UC3", SCENE), "jpeg", 80, 3)
