"""ALVideoRecorder of the simulated robot. Only NAOqi methods live in the service."""

from __future__ import annotations

import posixpath
from dataclasses import replace
from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.settings import CameraTables
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.cameras.picture_settings import PictureSettings
from nao_sim_bridge.naoqi.cameras.video_recorder_file import FORMATS
from nao_sim_bridge.naoqi.cameras.video_recorder_recording import FilmSettings, VideoRecorder

NAME = "ALVideoRecorder"
QVGA, VGA, GREY, BGR = 1, 2, 0, 13
RESOLUTIONS = (0, QVGA, VGA)
ENDING = ".avi"
# Frames a second: at most, at most in VGA, and with MJPG more than so many.
MOST_FPS, MOST_FPS_VGA, ABOVE_FPS_MJPG = 30.0, 15.0, 2.0


class ALVideoRecorder(PictureSettings):
    """ALVideoRecorder as the simulated robot offers it."""

    def __init__(self, recorder: VideoRecorder, files: ClientFiles, tables: CameraTables) -> None:
        first = FilmSettings(camera=0, resolution=QVGA, color_space=BGR, rate=15.0, kind="MJPG")
        super().__init__(tables, first)
        self._recorder = recorder
        self._files = files

    def startRecording(self, folder: str, name: str, overwrite: bool = True) -> Task:
        """Record from now on, with the present settings."""
        settings = self._settings
        if settings.kind == "IYUV" and settings.color_space == GREY:
            raise NaoqiError("IYUV has no grey films: set the colour space 13 (BGR), or the format MJPG")
        if settings.kind == "MJPG" and settings.rate <= ABOVE_FPS_MJPG:
            raise BadValue("frameRate", settings.rate, f"more than {ABOVE_FPS_MJPG:g} with MJPG")
        if settings.resolution == VGA:
            settings = replace(settings, rate=min(settings.rate, MOST_FPS_VGA))
        if not posixpath.basename(name):
            raise BadValue("fileName", name, "the name of a file")
        path = self._files.to_write(posixpath.join(folder, name if name.endswith(ENDING) else name + ENDING))
        if path.exists() and not overwrite:
            raise NaoqiError(f"file {str(path)!r} exists already, and is not to be overwritten")
        return self._recorder.start(path, settings)

    def stopRecording(self) -> Task:
        """End the recording; the answer is [number of frames, path]."""
        return self._recorder.stop()

    def isRecording(self) -> bool:
        return self._recorder.records

    def setResolution(self, resolution: int) -> None:
        if resolution not in RESOLUTIONS:
            raise BadValue("resolution", resolution, "0 (160x120), 1 (320x240) or 2 (640x480)")
        super().setResolution(resolution)

    def setFrameRate(self, rate: Any) -> None:
        """Frames a second, 1 to 30; in VGA no more than 15 are recorded."""
        self._settings = replace(self._settings, rate=number(rate, "frameRate", 1.0, MOST_FPS))

    def getFrameRate(self) -> int:
        return round(self._settings.rate)

    def setVideoFormat(self, kind: str) -> None:
        if kind not in FORMATS:
            raise BadValue("videoFormat", kind, " or ".join(FORMATS))
        self._settings = replace(self._settings, kind=kind)

    def getVideoFormat(self) -> str:
        return self._settings.kind
