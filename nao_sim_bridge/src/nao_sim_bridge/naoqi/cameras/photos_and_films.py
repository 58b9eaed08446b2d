"""ALPhotoCapture and ALVideoRecorder of the simulated robot, and what they have in common."""

from __future__ import annotations

import posixpath
from dataclasses import replace
from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import LONGEST_PATH, ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.settings import CameraTables
from nao_sim_bridge.naoqi.binding.arguments import number, one_of, text, whole_number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.cameras.film_recorder import FORMATS as FILM_FORMATS
from nao_sim_bridge.naoqi.cameras.film_recorder import FilmSettings, VideoRecorder
from nao_sim_bridge.naoqi.cameras.photographer import FORMATS, Photographer, PhotoSettings, check_new, picture_files

PHOTOS, FILMS = "ALPhotoCapture", "ALVideoRecorder"
QVGA, VGA, GREY, BGR = 1, 2, 0, 13
COLOR_SPACES = {GREY: "grey", BGR: "BGR"}
MOST_PICTURES = 10000
LONGEST_INTERVAL_MS = 3600000
FILM_RESOLUTIONS = (0, QVGA, VGA)
ENDING = ".avi"
# Frames a second: at most, at most in VGA, and with MJPG more than so many.
MOST_FPS, MOST_FPS_VGA, ABOVE_FPS_MJPG = 30.0, 15.0, 2.0


class PictureSettings:
    """The settings that photos and films have in common."""

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


class ALPhotoCapture(PictureSettings):
    """ALPhotoCapture as the simulated robot offers it."""

    def __init__(self, photographer: Photographer, files: ClientFiles, tables: CameraTables) -> None:
        super().__init__(tables, PhotoSettings(camera=0, resolution=VGA, color_space=BGR, interval=0.2))
        self._photographer = photographer
        self._files = files
        self._format = "jpg"

    def takePicture(self, folder: str, name: str, overwrite: bool = True) -> Task:
        """Take one picture; the answer is [path]."""
        return self._take(1, folder, name, overwrite)

    def takePictures(self, count: int, folder: str, name: str, overwrite: bool = True) -> Task:
        """Take pictures at the capture interval; the answer comes after the last one and is [[path, ...]]."""
        whole_number(count, "numberOfPictures", 1, MOST_PICTURES)
        return self._take(count, folder, name, overwrite).then(lambda paths: [paths])

    def halfPress(self) -> bool:
        """Hold the camera ready with the present settings, or let it go."""
        if self._photographer.held:
            self._photographer.release()
        else:
            self._photographer.hold(self._settings)
        return True

    def isHalfPressed(self) -> bool:
        return self._photographer.held

    def setHalfPressEnabled(self, enable: bool) -> None:
        """Whether the camera is held ready from one picture to the next."""
        self._photographer.keep(enable)

    def isHalfPressEnabled(self) -> bool:
        return self._photographer.keeps

    def setCaptureInterval(self, interval: int) -> None:
        """Time between the pictures of a series, ms; a camera gives no more than its highest rate."""
        milliseconds = number(interval, "captureInterval", 1, LONGEST_INTERVAL_MS)
        self._settings = replace(self._settings, interval=milliseconds / 1000.0)

    def getCaptureInterval(self) -> int:
        return round(1000.0 * self._settings.interval)

    def setPictureFormat(self, name: str) -> None:
        self._format = one_of(name, "pictureFormat", FORMATS)

    def getPictureFormat(self) -> str:
        return self._format

    def _take(self, count: int, folder: str, name: str, overwrite: bool) -> Task:
        text(folder, "folderPath", LONGEST_PATH)
        text(name, "fileName", LONGEST_PATH)
        paths = picture_files(self._files, folder, name, self._format, count, overwrite)
        taking = self._photographer.take(paths, self._settings)
        return taking.then(lambda taken: [self._files.to_robot(path) for path in taken or ()])


class ALVideoRecorder(PictureSettings):
    """ALVideoRecorder as the simulated robot offers it."""

    def __init__(self, recorder: VideoRecorder, files: ClientFiles, tables: CameraTables) -> None:
        super().__init__(tables, FilmSettings(camera=0, resolution=QVGA, color_space=BGR, rate=15.0, kind="MJPG"))
        self._recorder = recorder
        self._files = files

    def startRecording(self, folder: str, name: str, overwrite: bool = True) -> Task:
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
        check_new(self._files, [path], overwrite)
        return self._recorder.start(path, settings)

    def stopRecording(self) -> Task:
        """End the recording; the answer is [number of frames, path]."""
        return self._recorder.stop().then(self._on_robot)

    def isRecording(self) -> bool:
        return self._recorder.records

    def _on_robot(self, film: list[Any]) -> list[Any]:
        frames, path = film
        return [frames, self._files.to_robot(path) if path else ""]

    def setResolution(self, resolution: int) -> None:
        if resolution not in FILM_RESOLUTIONS:
            raise BadValue("resolution", resolution, "0 (160x120), 1 (320x240) or 2 (640x480)")
        super().setResolution(resolution)

    def setFrameRate(self, rate: Any) -> None:
        """Frames a second, 1 to 30; in VGA no more than 15 are recorded."""
        self._settings = replace(self._settings, rate=number(rate, "frameRate", 1.0, MOST_FPS))

    def getFrameRate(self) -> int:
        return round(self._settings.rate)

    def setVideoFormat(self, kind: str) -> None:
        if kind not in FILM_FORMATS:
            raise BadValue("videoFormat", kind, " or ".join(FILM_FORMATS))
        self._settings = replace(self._settings, kind=kind)

    def getVideoFormat(self) -> str:
        return self._settings.kind
