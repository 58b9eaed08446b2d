"""ALPhotoCapture of the simulated robot. Only NAOqi methods live in the service."""

from __future__ import annotations

from dataclasses import replace

from nao_sim_bridge.record_dir import LONGEST_PATH, ClientFiles
from nao_sim_bridge.services.arguments import number, text, whole_number
from nao_sim_bridge.services.vision.photo_capture_files import FORMATS, picture_files
from nao_sim_bridge.services.vision.photo_capture_series import Photographer, PhotoSettings
from nao_sim_bridge.sim.cameras.settings import CameraTables
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.tasks import Task

NAME = "ALPhotoCapture"
VGA = 2
COLOR_SPACES = {0: "grey", 13: "BGR"}
BGR = 13
MOST_PICTURES = 10000
LONGEST_INTERVAL_MS = 3600000


class ALPhotoCapture:
    """ALPhotoCapture as the simulated robot offers it.

    Args:
        photographer: Takes the pictures.
        files: Where clients may have files written to.
        tables: What the cameras can do.
    """

    def __init__(self, photographer: Photographer, files: ClientFiles, tables: CameraTables) -> None:
        self._photographer = photographer
        self._files = files
        self._tables = tables
        self._settings = PhotoSettings(camera=0, resolution=VGA, color_space=BGR, interval=0.2)
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

    def setCameraID(self, camera: int) -> None:
        self._settings = replace(self._settings, camera=self._tables.camera(camera))

    def getCameraID(self) -> int:
        return self._settings.camera

    def setResolution(self, resolution: int) -> None:
        self._settings = replace(self._settings, resolution=self._tables.resolution(resolution).id)

    def getResolution(self) -> int:
        return self._settings.resolution

    def setColorSpace(self, color_space: int) -> None:
        self._settings = replace(self._settings, color_space=grey_or_color(color_space))

    def getColorSpace(self) -> int:
        return self._settings.color_space

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


def grey_or_color(color_space: int) -> int:
    """One of the two colour spaces that files of pictures and films are made from.

    Raises:
        BadValue: It is another one.
    """
    if not isinstance(color_space, int) or color_space not in COLOR_SPACES:
        raise BadValue("colorSpace", color_space, " or ".join(f"{i} ({text})" for i, text in COLOR_SPACES.items()))
    return color_space
