"""Part of ALVideoDevice: pictures from outside that the cameras see instead of the world."""

from __future__ import annotations

from typing import Any

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.naoqi.binding.arguments import whole_number

LAYERS = 3
SIZE = (640, 480)
MOST_PIXELS = 2560 * 1920
IDLE_RESOLUTION, IDLE_RATE = 1, 5


class VideoDeviceInputs:
    """The first picture takes a camera's place in the world; `resetCamera` gives it back."""

    def __init__(self, cameras: Cameras) -> None:
        self._cameras = cameras
        self._size = SIZE

    def getExpectedImageParameters(self, *camera: int) -> list:
        index = self._cameras.tables.camera(camera[0]) if camera else self._cameras.active
        streams = [stream for stream in self._cameras.streams if stream.camera == index]
        largest = max((stream.size for stream in streams), key=lambda size: size.width, default=None)
        return [largest.id if largest else IDLE_RESOLUTION, round(self._cameras.rate(index)) or IDLE_RATE]

    def setSimCamInputSize(self, width: int, height: int) -> bool:
        self._size = _size(width, height)
        return True

    def putImage(self, *arguments: Any) -> bool:
        *where, pixels = arguments
        camera, width, height = where or (self._cameras.active, *self._size)
        self._cameras.show(self._cameras.tables.camera(camera), _picture(pixels, *_size(width, height)))
        return True


def _size(width: int, height: int) -> tuple[int, int]:
    whole_number(width, "width", 2, MOST_PIXELS)
    whole_number(height, "height", 2, MOST_PIXELS)
    if width * height > MOST_PIXELS:
        raise BadValue("width and height", (width, height), f"at most {MOST_PIXELS} pixels")
    return width, height


def _picture(pixels: Any, width: int, height: int) -> np.ndarray:
    """(height, width, 3) RGB of its bytes."""
    expected = width * height * LAYERS
    if not isinstance(pixels, (bytes, bytearray)):
        raise BadValue("imageBuffer", pixels, f"{expected} raw bytes")
    if len(pixels) != expected:
        raise BadValue(
            "length of imageBuffer", len(pixels), f"{expected}: {LAYERS} bytes (RGB) a pixel, {width}x{height}"
        )
    return np.frombuffer(bytes(pixels), dtype=np.uint8).reshape(height, width, LAYERS)
