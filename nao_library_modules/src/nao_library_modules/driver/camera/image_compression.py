"""Pictures as JPEG and PNG, in the formats of image_transport. No ROS."""

from __future__ import annotations

from typing import Any

import numpy as np

from naoqi.errors import NaoError

from ...base.doors import Later
from .camera_formats import BGR, BYTES, GREY, RGB, YUV422, Picture

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
