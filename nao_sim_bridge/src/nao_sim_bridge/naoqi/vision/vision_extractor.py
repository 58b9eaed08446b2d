"""What NAOqi's extractors with a camera have in common: methods, the event of what was seen last, values of events."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.settings import CameraTables
from nao_sim_bridge.naoqi.binding.switch import SwitchModule
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.watching import MOST_FPS, Watching


class VisionExtractor(SwitchModule):
    """Camera, resolution, frame rate and pause of an extractor. No other methods are public."""

    def __init__(self, watching: Watching, tables: CameraTables) -> None:
        super().__init__(watching, {"pause": self.pause, "resolution": self.setResolution})
        self._watching = watching
        self._tables = tables

    def getActiveCamera(self) -> int:
        return self._watching.camera

    def setActiveCamera(self, camera: int) -> bool:
        self._watching.set_camera(self._tables.camera(camera))
        return True

    def getFrameRate(self) -> int:
        return self._watching.fps

    def setFrameRate(self, *arguments: Any) -> bool:
        """(rate) for all subscribers, or (subscriber, rate)."""
        *subscriber, fps = arguments
        if isinstance(fps, bool) or not isinstance(fps, int) or not 1 <= fps <= MOST_FPS:
            raise BadValue("framerate", fps, f"1 to {MOST_FPS} pictures a second")
        self._watching.set_fps(fps, *subscriber)
        return True

    def getResolution(self) -> int:
        return self._watching.resolution

    def setResolution(self, resolution: int) -> bool:
        self._watching.set_resolution(self._tables.resolution(resolution).id)
        return True


class Sight:
    """The event of one extractor. Used by its watching only, so in one thread at a time.

    With `tell_end` subscribers are also told when nothing is seen any more, with an empty list; else that is only
    written, for those who read the key.
    """

    def __init__(self, memory: MemoryStore, event: str, tell_end: bool) -> None:
        self._memory = memory
        self._event = event
        self._tell_end = tell_end
        self._something = False
        memory.put_quietly(event, [])

    def show(self, value: list[Any]) -> None:
        self._something = True
        self._memory.raise_event(self._event, value)

    def nothing(self) -> None:
        if self._something and self._tell_end:
            self._memory.raise_event(self._event, [])
        elif self._something:
            self._memory.put_quietly(self._event, [])
        self._something = False


def in_picture(frame: Frame, seen: Any, camera: Any) -> list[Any]:
    """[[seconds, microseconds], what was seen, pose of the camera in FRAME_TORSO, the same in FRAME_ROBOT, camera]."""
    return [list(frame.stamp), seen, list(frame.pose_in_torso), list(frame.pose_in_robot), camera]
