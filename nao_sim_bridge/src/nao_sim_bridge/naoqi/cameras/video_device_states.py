"""Which cameras are open and which take pictures: what clients have said, and who looks."""

from __future__ import annotations

import threading
from typing import Callable

from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.cameras.settings import CAMERAS
from nao_sim_bridge.naoqi.binding.errors import NaoqiError


class CameraStates:
    """The cameras' states. A camera is open and runs by itself while somebody looks; any thread.

    Args:
        fail: Called with a camera and a reason when there will be no frames.
    """

    def __init__(self, cameras: Cameras, fail: Callable[[int, str], None]) -> None:
        self._cameras = cameras
        self._fail = fail
        self._lock = threading.RLock()
        self._opened = [False for _ in CAMERAS]
        self._started = [False for _ in CAMERAS]
        self._closed = [False for _ in CAMERAS]

    def is_open(self, camera: int) -> bool:
        return not self._closed[camera] and (self._opened[camera] or self._wanted(camera))

    def runs(self, camera: int) -> bool:
        return not self._cameras.stopped(camera) and (self._started[camera] or self._wanted(camera))

    def open(self, camera: int) -> None:
        """Open it; if it had been closed, it takes no pictures before it is started."""
        with self._lock:
            self._opened[camera], self._closed[camera] = True, False

    def close(self, camera: int) -> None:
        """Close it: nobody gets pictures any more."""
        with self._lock:
            self._opened[camera], self._closed[camera] = False, True
            self._stop(camera, "closed: openCamera and startCamera")

    def start(self, camera: int) -> None:
        """Let it take pictures.

        Raises:
            NaoqiError: It is closed.
        """
        with self._lock:
            if self._closed[camera]:
                raise NaoqiError(f"camera {camera} is closed; open it with openCamera first")
            self._opened[camera] = self._started[camera] = True
            self._cameras.set_stopped(camera, False)

    def stop(self, camera: int) -> None:
        with self._lock:
            self._stop(camera, "stopped: startCamera")

    def use(self, camera: int) -> None:
        """Somebody begins to look: whatever it was, it runs."""
        with self._lock:
            self._closed[camera] = False
            self._cameras.set_stopped(camera, False)

    def reset(self, camera: int) -> None:
        """As at the start."""
        with self._lock:
            self._opened[camera] = self._started[camera] = False
            self.use(camera)

    def check(self, camera: int) -> None:
        """Make sure that a camera has pictures for somebody who looks.

        Raises:
            NaoqiError: It is closed or stopped.
        """
        with self._lock:
            if self._closed[camera]:
                raise NaoqiError(_no_pictures(camera, "closed: openCamera and startCamera"))
            if self._cameras.stopped(camera):
                raise NaoqiError(_no_pictures(camera, "stopped: startCamera"))

    def _stop(self, camera: int, reason: str) -> None:
        self._started[camera] = False
        self._cameras.set_stopped(camera, True)
        self._fail(camera, _no_pictures(camera, reason))

    def _wanted(self, camera: int) -> bool:
        looked = any(stream.camera == camera for stream in self._cameras.streams)
        return looked or self._cameras.kept_alive(camera)


def _no_pictures(camera: int, reason: str) -> str:
    return f"camera {camera} gives no pictures, it is {reason} lets it go on"
