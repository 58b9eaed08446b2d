"""What ALPhotoCapture and ALVideoRecorder share: camera, size and colours. Only NAOqi methods live here."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.settings import CameraTables

COLOR_SPACES = {0: "grey", 13: "BGR"}


class PictureSettings:
    """Settings that pictures and films have.

    Args:
        settings: The first settings: a dataclass with `camera`, `resolution` and `color_space`, NAOqi's numbers.
    """

    def __init__(self, tables: CameraTables, settings: Any) -> None:
        self._tables = tables
        self._settings = settings

    def setCameraID(self, camera: int) -> None:
        self._settings = replace(self._settings, camera=self._tables.camera(camera))

    def getCameraID(self) -> int:
        return self._settings.camera

    def setResolution(self, resolution: int) -> None:
        self._settings = replace(self._settings, resolution=self._tables.resolution(resolution).id)

    def getResolution(self) -> int:
        return self._settings.resolution

    def setColorSpace(self, color_space: int) -> None:
        if not isinstance(color_space, int) or color_space not in COLOR_SPACES:
            raise BadValue("colorSpace", color_space, " or ".join(f"{i} ({text})" for i, text in COLOR_SPACES.items()))
        self._settings = replace(self._settings, color_space=color_space)

    def getColorSpace(self) -> int:
        return self._settings.color_space
