"""Images of the cameras: formats, compression, and their ROS messages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_msgs.msg import Header

import vision_definitions as vision
from naoqi.errors import NaoError

from ...core.lazy import Later
from ...core.nao_facts import CAMERAS, SIZES
from .camera_calibration import NO_ROTATION, PLUMB_BOB, Calibration

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


cv2 = Later("cv2")
JPEG, PNG = "jpeg", "png"
FORMATS = {JPEG: "small, with losses", PNG: "large, without losses"}


def compress(picture: Picture, kind: str, jpeg_quality: int, png_level: int) -> tuple[str, bytes]:
    """A picture as a file, and its format in sensor_msgs/CompressedImage.

    `picture`: in colours or grey. `kind`: jpeg or png. `jpeg_quality`: 1 to 100. `png_level`: 1 (quick) to 9 (small).
    Raises NaoError for other encodings, or if OpenCV fails.
    """
    pixels, colours = _as_opencv(picture)
    options: list[Any] = [cv2.IMWRITE_JPEG_QUALITY, jpeg_quality]
    if kind == PNG:
        options = [cv2.IMWRITE_PNG_COMPRESSION, png_level]
    done, file = cv2.imencode(f".{kind}", pixels, options)
    if not done:
        raise NaoError(f"OpenCV cannot write a picture of {picture.width}x{picture.height} as {kind}")
    return f"{picture.encoding}; {kind} compressed {colours}", file.tobytes()


def _as_opencv(picture: Picture) -> tuple[np.ndarray, str]:
    """The pixels in OpenCV's order, and image_transport's name of their colours."""
    layers = BYTES[picture.encoding]
    shape = (picture.height, picture.width) if layers == 1 else (picture.height, picture.width, layers)
    pixels = np.frombuffer(picture.pixels, dtype=np.uint8).reshape(shape)
    if picture.encoding == GREY:
        return pixels, ""
    if picture.encoding == BGR:
        return pixels, BGR
    if picture.encoding == RGB:
        return cv2.cvtColor(pixels, cv2.COLOR_RGB2BGR), BGR
    if picture.encoding == YUV422:
        return cv2.cvtColor(pixels, cv2.COLOR_YUV2BGR_UYVY), BGR
    raise NaoError(
        f"only pictures in colours or grey are compressed, not {picture.encoding}: choose another color_space"
    )


def to_image(picture: Picture, header: Header) -> Image:
    """A picture; its pixels are not copied."""
    return Image(
        header=header,
        height=picture.height,
        width=picture.width,
        encoding=picture.encoding,
        is_bigendian=0,
        step=picture.step,
        data=picture.pixels,
    )


def to_compressed(kind: str, file: bytes, header: Header) -> CompressedImage:
    return CompressedImage(header=header, format=kind, data=file)


def to_info(calibration: Calibration | None, width: int, height: int, header: Header) -> CameraInfo:
    """The calibration of pictures of a size; without one, all numbers are zero, as CameraInfo defines it."""
    info = CameraInfo(header=header, width=width, height=height)
    if calibration is not None:
        info.distortion_model = calibration.model
        info.D, info.K = list(calibration.d), list(calibration.k)
        info.R, info.P = list(calibration.r), list(calibration.p)
    return info


def from_info(info: CameraInfo) -> Calibration:
    """The calibration in a message; raises NaoError if it holds none."""
    projection = tuple(info.P) if any(info.P) else ()
    rotation = tuple(info.R) if any(info.R) else NO_ROTATION
    model = info.distortion_model or PLUMB_BOB
    return Calibration(info.width, info.height, tuple(info.K), tuple(info.D), rotation, projection, model)


def header_of(time: float, frame: str) -> Header:
    """A header of ROS time `time`, s; rounded to microseconds, the robot's resolution."""
    seconds, microseconds = divmod(round(time * 1e6), 1000000)
    return Header(stamp=rospy.Time(seconds, 1000 * microseconds), frame_id=frame)
