"""ALVisionToolbox, which took pictures and videos before NAOqi 2.0, and told what the light is like."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.cameras.frame import Answer, Frame
from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.naoqi.cameras.photos_and_films import BGR, QVGA, ALPhotoCapture, ALVideoRecorder
from nao_sim_bridge.naoqi.vision.light_detection import FPS, QQVGA, exposed
from nao_sim_bridge.vision.light import DARKEST, BacklightingDetector, DarknessDetector

PICTURES, VIDEOS = "/home/nao/recordings/cameras", "/home/nao/.local/share/naoqi/vision"
PICTURE = "image"
USUAL = 3
"""Pictures that `takePicture` takes."""
RATE, KIND = 15.0, "MJPG"
BRIGHT, DARK = 5, 255
"""What `isItDark` answers in a bright room, and where there is no light; lower values are for outdoors."""
MOST_LOOKS = load_sizes().clients.series
"""Calls that wait for a picture at the same time."""


class ALVisionToolbox:
    """ALVisionToolbox as the simulated robot offers it, with `photos` and `films` of its own and their settings."""

    def __init__(
        self, photos: Callable[[], ALPhotoCapture], films: Callable[[], ALVideoRecorder], cameras: Cameras
    ) -> None:
        self._photos = photos()
        self._films = films()
        self._cameras = cameras
        self._looks: set[Task] = set()

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

    def isItDark(self) -> Task:
        """5 in a bright room to 255 in the dark, with exposure and gain of the camera allowed for."""
        looking = self._look("isItDark", DarknessDetector(), lambda frame: exposed(self._cameras, frame))
        return looking.then(lambda dark: None if looking.killed else round(BRIGHT + (DARK - BRIGHT) * dark / DARKEST))

    def backlighting(self) -> Task:
        """0 not backlit, 1 possibly, 2 surely."""
        return self._look("backlighting", BacklightingDetector())

    def _look(self, call: str, detector: Any, settings: Callable[[Frame], Any] = lambda _: None) -> Task:
        """Ends with what is in the next picture of the camera that is active."""
        if len(self._looks) >= MOST_LOOKS:
            raise BadValue("calls that wait for a picture", len(self._looks) + 1, f"at most {MOST_LOOKS}")
        stream = self._cameras.open(call, self._cameras.active, QQVGA, BGR, FPS, every=True)
        task = Task(call, 0, ask=lambda asked: asked.kill())
        self._looks.add(task)

        def end(_: Task) -> None:
            self._looks.discard(task)
            stream.close()

        def hear(answer: Answer) -> None:
            if isinstance(answer, Exception):
                task.finish(error=answer)
            else:
                optics = Optics(answer.hfov, answer.vfov)
                task.finish_with(lambda: detector.detect(answer.array(), optics, settings(answer)))

        task.add_done_callback(end)
        stream.ask(hear)
        return task
