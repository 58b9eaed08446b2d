"""Pictures of ALVideoDevice, and ROS's names for their sizes and colours. No ROS."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import vision_definitions as vision
from naoqi.errors import NaoError

from ...nao.camera_facts import CAMERAS, SIZES

RESOLUTIONS = {number: f"{width}x{height}" for number, (width, height) in SIZES.items()}

GREY, BGR = "mono8", "bgr8"
RGB, YUV422 = "rgb8", "yuv422"
SPACES = {
    vision.kYuvColorSpace: ("Yuv", GREY),
    vision.kyUvColorSpace: ("yUv", "8UC1"),
    vision.kyuVColorSpace: ("yuV", "8UC1"),
    vision.kRgbColorSpace: ("Rgb", "8UC1"),
    vision.krGbColorSpace: ("rGb", "8UC1"),
    vision.krgBColorSpace: ("rgB", "8UC1"),
    vision.kHsyColorSpace: ("Hsy", "8UC1"),
    vision.khSyColorSpace: ("hSy", "8UC1"),
    vision.khsYColorSpace: ("hsY", "8UC1"),
    vision.kYUV422ColorSpace: ("YUV422", YUV422),
    vision.kYUVColorSpace: ("YUV", "8UC3"),
    vision.kRGBColorSpace: ("RGB", RGB),
    vision.kHSYColorSpace: ("HSY", "8UC3"),
    vision.kBGRColorSpace: ("BGR", BGR),
    vision.kH2RGBColorSpace: ("H2RGB", "8UC3"),
    vision.kHSMixedColorSpace: ("HSMixed", "8UC3"),
}
"""NAOqi's number of a colour space -> its name, and the encoding of sensor_msgs/Image that stands for it: plain bytes
where ROS has none."""
COLOR_SPACES = {number: f"{name}, encoding {encoding}" for number, (name, encoding) in SPACES.items()}
BYTES = {GREY: 1, "8UC1": 1, YUV422: 2, BGR: 3, RGB: 3, "8UC3": 3}
"""Encoding -> bytes a pixel."""
IMAGE_FIELDS = 7


@dataclass(frozen=True)
class Picture:
    """A picture of a camera."""

    time: float  # s, the robot's clock
    camera: int  # NAOqi's number
    width: int
    height: int
    encoding: str  # as in sensor_msgs/Image
    pixels: bytes  # row by row from the upper left

    @property
    def step(self) -> int:
        """Bytes of a row."""
        return self.width * BYTES[self.encoding]


def read_picture(image: Sequence[Any], camera: int) -> Picture:
    """A picture from an answer of getImageRemote.

    `image`: [width, height, layers, colour space, s, us, pixels, camera, ...]. `camera`: its camera, if the robot does
    not report it. Raises NaoError if it holds no picture, one of colours that ROS has no encoding for, or too few
    pixels.
    """
    if not isinstance(image, (list, tuple)) or len(image) < IMAGE_FIELDS:
        raise NaoError(f"the robot gave no picture but {str(image)[:100]}")
    width, height, _, space, seconds, microseconds, pixels = image[:IMAGE_FIELDS]
    _, encoding = SPACES.get(space, ("", ""))
    if not encoding:
        raise NaoError(f"the robot gave a picture of colour space {space}, which no encoding of ROS stands for")
    expected = width * height * BYTES[encoding]
    if not isinstance(pixels, (bytes, bytearray)) or len(pixels) != expected:
        found = f"{len(pixels)} bytes" if isinstance(pixels, (bytes, bytearray)) else type(pixels).__name__
        raise NaoError(f"a picture of {width}x{height} in {encoding} has {found}, not {expected} bytes")
    if encoding == YUV422:
        # NAOqi puts brightness first (YUYV), and what ROS calls yuv422 has colour first (UYVY).
        pixels = np.frombuffer(pixels, dtype=np.uint16).byteswap().tobytes()
    source = image[7] if len(image) > 7 and image[7] in CAMERAS else camera
    return Picture(seconds + 1e-6 * microseconds, source, width, height, encoding, pixels)
