"""Methods that NAOqi's extractors with a camera have in common."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.settings import CameraTables
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.vision.watching import MOST_FPS, Watching


class VisionExtractor:
    """Camera, resolution, frame rate and pause of an extractor. No other methods are public."""

    def __init__(self, watching: Watching, tables: CameraTables) -> None:
        self.watching = watching
        self._tables = tables
        self._parameters: dict[str, Callable[[Any], Any]] = {"pause": self.pause, "resolution": self.setResolution}

    def getActiveCamera(self) -> int:
        return self.watching.camera

    def setActiveCamera(self, camera: int) -> bool:
        self.watching.set_camera(self._tables.camera(camera))
        return True

    def getFrameRate(self) -> int:
        return self.watching.fps

    def setFrameRate(self, *arguments: Any) -> bool:
        """Change that, for all subscribers or for the one that is named first."""
        *subscriber, fps = arguments
        if isinstance(fps, bool) or not isinstance(fps, int) or not 1 <= fps <= MOST_FPS:
            raise BadValue("framerate", fps, f"1 to {MOST_FPS} pictures a second")
        self.watching.set_fps(fps, *subscriber)
        return True

    def getResolution(self) -> int:
        return self.watching.resolution

    def setResolution(self, resolution: int) -> bool:
        self.watching.set_resolution(self._tables.resolution(resolution).id)
        return True

    def pause(self, status: bool) -> None:
        self.watching.pause(bool(status))

    def isPaused(self) -> bool:
        return self.watching.paused

    def isProcessing(self) -> bool:
        return self.watching.looks

    def setParameter(self, parameter: str, value: Any) -> None:
        """Change how it looks; deprecated in NAOqi in favour of the methods above."""
        if parameter not in self._parameters:
            raise NaoqiError(f"unknown parameter {parameter!r}; there are {', '.join(self._parameters)}")
        self._parameters[parameter](value)
