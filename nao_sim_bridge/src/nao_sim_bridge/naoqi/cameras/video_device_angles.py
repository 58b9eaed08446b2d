"""Part of ALVideoDevice: places in the picture and angles, in both directions."""

from __future__ import annotations

import math
from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.naoqi.binding.arguments import numbers

LIMIT = 1.57
"""Angles beyond it, rad, are in no picture."""


class VideoDeviceAngles:
    """Places are normalised, (0, 0) upper left, (1, 1) lower right; angles are positive to the left and downwards."""

    def __init__(self, cameras: Cameras) -> None:
        self._cameras = cameras

    def getAngularPositionFromImagePosition(self, camera: int, place: Any) -> list:
        return list(self._cameras.optics(camera).angles(*_pair(place, "ImagePosition")))

    def getAngularSizeFromImageSize(self, camera: int, size: Any) -> list:
        return list(self._cameras.optics(camera).angular_size(*_pair(size, "ImageSize", least=0.0)))

    def getImagePositionFromAngularPosition(self, camera: int, angles: Any) -> list:
        return list(self._cameras.optics(camera).place(*_pair(angles, "AngularPosition", -LIMIT, LIMIT)))

    def getImageSizeFromAngularSize(self, camera: int, size: Any) -> list:
        return list(self._cameras.optics(camera).image_size(*_pair(size, "AngularSize", 0.0, 2.0 * LIMIT)))

    def getImageInfoFromAngularInfo(self, camera: int, info: Any) -> list:
        values = numbers(info, "AngularInfo")
        if len(values) != 4:
            raise BadValue("AngularInfo", info, "[alpha, beta, width, height] in rad")
        place = self.getImagePositionFromAngularPosition(camera, values[:2])
        return place + self.getImageSizeFromAngularSize(camera, values[2:])

    def getImageInfoFromAngularInfoWithResolution(self, camera: int, info: Any, resolution: int) -> list:
        size = self._cameras.tables.resolution(resolution)
        x, y, width, height = self.getImageInfoFromAngularInfo(camera, info)
        return [x * size.width, y * size.height, width * size.width, height * size.height]


def _pair(values: Any, field: str, least: float = -math.inf, most: float = math.inf) -> list[float]:
    pair = numbers(values, field, least, most)
    if len(pair) != 2:
        raise BadValue(field, values, "two numbers")
    return pair
