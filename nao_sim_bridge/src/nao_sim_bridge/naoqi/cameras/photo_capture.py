"""ALPhotoCapture of the simulated robot. Only NAOqi methods live in the service."""

from __future__ import annotations

from dataclasses import replace

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import LONGEST_PATH, ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.settings import CameraTables
from nao_sim_bridge.naoqi.binding.arguments import number, text, whole_number
from nao_sim_bridge.naoqi.cameras.photo_capture_files import FORMATS, picture_files
from nao_sim_bridge.naoqi.cameras.photo_capture_series import Photographer, PhotoSettings
from nao_sim_bridge.naoqi.cameras.picture_settings import PictureSettings

NAME = "ALPhotoCapture"
VGA = 2
BGR = 13
MOST_PICTURES = 10000
LONGEST_INTERVAL_MS = 3600000


class ALPhotoCapture(PictureSettings):
    """ALPhotoCapture as the simulated robot offers it."""

    def __init__(self, photographer: Photographer, files: ClientFiles, tables: CameraTables) -> None:
        super().__init__(tables, PhotoSettings(camera=0, resolution=VGA, color_space=BGR, interval=0.2))
        self._photographer = photographer
        self._files = files
        self._format = "jpg"

    def takePicture(self, folder: str, name: str, overwrite: bool = True) -> Task:
        """Take one picture; the answer is [path]."""
        return self._take(1, folder, name, overwrite).then(lambda paths: paths)

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
        if name not in FORMATS:
            raise BadValue("pictureFormat", name, "one of " + ", ".join(FORMATS))
        self._format = name

    def getPictureFormat(self) -> str:
        return self._format

    def _take(self, count: int, folder: str, name: str, overwrite: bool) -> Task:
        text(folder, "folderPath", LONGEST_PATH)
        text(name, "fileName", LONGEST_PATH)
        paths = picture_files(self._files, folder, name, self._format, count, overwrite)
        return self._photographer.take(paths, self._settings)
