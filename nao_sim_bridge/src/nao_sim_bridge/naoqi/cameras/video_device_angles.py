"""Part of ALVideoDevice: sizes of pictures, and places in them and angles, in both directions."""

from __future__ import annotations

import math
from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.naoqi.binding.arguments import numbers
from nao_sim_bridge.naoqi.cameras.video_device_cameras import of_active

LIMIT = 1.57
"""Angles beyond it, rad, are in no picture."""
UNKNOWN = -1


class VideoDeviceAngles:
    """Places are normalised, (0, 0) upper left, (1, 1) lower right; angles are positive to the left and downwards."""

    def __init__(self, cameras: Cameras) -> None:
        self._cameras = cameras

    def resolutionToSizes(self, resolution: int) -> list:
        size = self._cameras.tables.resolution(resolution)
        return [size.width, size.height]

    def sizesToResolution(self, width: int, height: int) -> int:
        sizes = {(size.width, size.height): size.id for size in self._cameras.tables.resolutions.values()}
        return sizes.get((width, height), UNKNOWN)

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

    getAngPosFromImgPos = of_active(getAngularPositionFromImagePosition)
    getAngSizeFromImgSize = of_active(getAngularSizeFromImageSize)
    getImgPosFromAngPos = of_active(getImagePositionFromAngularPosition)
    getImgSizeFromAngSize = of_active(getImageSizeFromAngularSize)
    getImgInfoFromAngInfo = of_active(getImageInfoFromAngularInfo)
    getImgInfoFromAngInfoWithRes = of_active(getImageInfoFromAngularInfoWithResolution)


def _pair(values: Any, field: str, least: float = -math.inf, most: float = math.inf) -> list[float]:
    pair = numbers(values, field, least, most)
    if len(pair) != 2:
        raise BadValue(field, values, "two numbers")
    return pair
