"""ALVisionToolbox, which took pictures and videos before NAOqi 2.0."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.cameras.photos_and_films import QVGA, ALPhotoCapture, ALVideoRecorder

PICTURES, VIDEOS = "/home/nao/recordings/cameras", "/home/nao/.local/share/naoqi/vision"
PICTURE = "image"
USUAL = 3
"""Pictures that `takePicture` takes."""
RATE, KIND = 15.0, "MJPG"


class ALVisionToolbox:
    """ALVisionToolbox as the simulated robot offers it, with `photos` and `films` of its own and their settings."""

    def __init__(self, photos: Callable[[], ALPhotoCapture], films: Callable[[], ALVideoRecorder]) -> None:
        self._photos = photos()
        self._films = films()

    def halfPress(self) -> None:
        self._photos.halfPress()

    def takePicture(self) -> Task:
        return self.takePictures(USUAL)

    def takePictures(self, count: int) -> Task:
        return self._photos.takePictures(count, PICTURES, PICTURE).then(lambda _: None)

    def startVideoRecord(self, name: str) -> Task:
        return self.startVideoRecord_adv(name, RATE, KIND, QVGA, -1)

    def startVideoRecord_adv(self, name: str, rate: float, kind: str, resolution: int, frames: int) -> Task:
        if frames >= 0:
            raise BadValue("numFrames", frames, "less than 0; stopVideoRecord ends the video")
        self._films.setFrameRate(rate)
        self._films.setVideoFormat(kind)
        self._films.setResolution(resolution)
        return self._films.startRecording(VIDEOS, name)

    def stopVideoRecord(self) -> Task:
        return self._films.stopRecording()

    def isVideoRecording(self) -> bool:
        return self._films.isRecording()
