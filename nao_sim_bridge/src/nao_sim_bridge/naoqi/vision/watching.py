"""What the extractors that look through the cameras share: they look while somebody is subscribed, unless paused."""

from __future__ import annotations

import logging
import math
import threading
from typing import Any, Callable, Mapping, Protocol

from nao_sim_bridge.cameras.cameras import CameraClosed, Cameras, CameraStream
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.binding.switch import Switch
from nao_sim_bridge.naoqi.memory.extractor import DEFAULT_PERIOD_MS, Subscription
from nao_sim_bridge.vision.client import VisionClosed

log = logging.getLogger("nao_sim.vision")

BGR = 13
"""NAOqi's id of the colour space that detectors get."""
QVGA = 1
TOP = 0
MOST_FPS = 30
PATIENCE = 1.0
"""How long to wait for a picture before asking again, s of wall time."""
CLOSING = 5.0
"""How long who stops a watching waits for its thread, s of wall time."""
EARLY = 1e-3
"""s; a picture that comes this much before its period is over counts as due: periods are whole milliseconds."""


class DetectorHandle(Protocol):
    """What a watching needs of a RemoteDetector."""

    def detect(self, image: Any, optics: Optics, settings: Any) -> Any:
        """What is in a picture."""

    def close(self) -> None:
        """Forget what earlier pictures showed."""


class Watching(Switch):
    """Looks through a camera for one module: every picture that is due goes to its detector, in a thread of its own.

    It looks at most as often as the frame rate says, and no sooner after a picture than the period of its subscribers
    (the shortest counts); their precision changes nothing. Time that runs faster than the wall clock waits until a
    picture has been looked at and its event raised, so a fast run has the same events at the same times; else pictures
    that come while it is busy are left out. Any thread may call.

    Args:
        detector: Closed whenever nobody wants results any more, so that it starts afresh.
        on_result: Called in the thread with each picture and what was found in it.
        settings: Called in the thread with each picture for what the detector is to be told.
        on_stop: Called when nothing is looked at any more (nobody is subscribed, or paused), after the last result.
        camera: The camera at the start; None to look through the one that ALVideoDevice has active.
        resolution: NAOqi's id.
    """

    def __init__(
        self,
        cameras: Cameras,
        name: str,
        detector: DetectorHandle,
        on_result: Callable[[Frame, Any], None],
        settings: Callable[[Frame], Any] = lambda _: None,
        on_stop: Callable[[], None] = lambda: None,
        camera: int | None = TOP,
        resolution: int = QVGA,
        fps: int = MOST_FPS,
    ) -> None:
        super().__init__()
        self._cameras = cameras
        self._name = name
        self._detector = detector
        self._on_result = on_result
        self._settings = settings
        self._on_stop = on_stop
        self._camera = camera
        self.resolution = resolution
        self._fps = fps
        self._fps_of: dict[str, int] = {}  # subscribers with a rate of their own
        self._subscribers: frozenset[str] = frozenset()
        self._period = DEFAULT_PERIOD_MS / 1000.0
        self._stream: CameraStream | None = None
        self._thread: threading.Thread | None = None
        self._failed = False

    @property
    def runs(self) -> bool:
        return self._stream is not None

    @property
    def camera(self) -> int:
        """Index of the camera that it looks through, or would."""
        return self._cameras.active if self._camera is None else self._camera

    @property
    def fps(self) -> int:
        """The most pictures a second: the highest rate that a subscriber wants."""
        rates = [self._fps_of.get(name, self._fps) for name in self._subscribers]
        return max(rates, default=self._fps)

    # --- for the extractor ------------------------------------------------------------------------------------------

    def changed(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Who is subscribed now, and what they ask for."""
        with self._lock:
            self._subscribers = frozenset(subscriptions)
            self._fps_of = {name: fps for name, fps in self._fps_of.items() if name in subscriptions}
            self._period = min((s.period for s in subscriptions.values()), default=DEFAULT_PERIOD_MS) / 1000.0
            self._set_stream_rate()

    # --- for the module ---------------------------------------------------------------------------------------------

    def set_camera(self, camera: int) -> None:
        with self._lock:
            if self._stream is not None:
                self._stream.camera = camera
            self._camera = camera

    def set_resolution(self, resolution: int) -> None:
        with self._lock:
            if self._stream is not None:
                self._stream.resolution = resolution
            self.resolution = resolution

    def set_fps(self, fps: int, subscriber: str | None = None) -> None:
        """The most pictures a second, for everybody or for one subscriber.

        A NaoqiError when there is no such subscriber.
        """
        with self._lock:
            if subscriber is None:
                self._fps = fps
                self._fps_of.clear()
            elif subscriber in self._subscribers:
                self._fps_of[subscriber] = fps
            else:
                known = ", ".join(map(repr, sorted(self._subscribers))) or "nobody"
                raise NaoqiError(f"{subscriber!r} is not subscribed; subscribed is {known}")
            self._set_stream_rate()

    def _update(self) -> None:
        if self._works and self._stream is None:
            self._begin()
        elif not self._works and self._stream is not None:
            self._end()

    def _begin(self) -> None:
        self._stream = self._cameras.open(
            self._name, self.camera, self.resolution, BGR, self._stream_rate(), every=True
        )
        self._failed = False
        self._thread = threading.Thread(target=self._run, args=(self._stream,), name=self._name, daemon=True)
        self._thread.start()

    def _end(self) -> None:
        stream, self._stream = self._stream, None
        stream.close()
        if threading.current_thread() is not self._thread:
            self._thread.join(CLOSING)
        self._detector.close()
        self._on_stop()

    def _stream_rate(self) -> int:
        """The camera's rate: the highest that leaves the period between two pictures."""
        if self._period <= 0.0:
            return self.fps
        return max(1, min(self.fps, math.floor(1.0 / self._period + EARLY)))

    def _set_stream_rate(self) -> None:
        if self._stream is not None and self._stream.fps != self._stream_rate():
            self._stream.fps = self._stream_rate()

    # --- in the thread ----------------------------------------------------------------------------------------------

    def _run(self, stream: CameraStream) -> None:
        last = -math.inf
        while stream is self._stream:
            try:
                frame = stream.take(PATIENCE)
            except TimeoutError:
                continue
            except CameraClosed:
                return
            except Exception as error:
                self._tell_failure(error)
                continue
            if self._camera is None and frame.camera != self.camera:
                stream.camera = self.camera
                continue
            if frame.time < last + self._period - EARLY:
                continue
            last = frame.time
            self._look(stream, frame)

    def _look(self, stream: CameraStream, frame: Frame) -> None:
        try:
            found = self._detector.detect(frame.array(), Optics(frame.hfov, frame.vfov), self._settings(frame))
            if stream is self._stream:  # nobody wants it any more when that has been closed meanwhile
                self._on_result(frame, found)
        except VisionClosed:
            pass  # the robot is being shut down
        except Exception as error:
            if stream is self._stream:
                self._tell_failure(error)
        else:
            self._failed = False

    def _tell_failure(self, error: Exception) -> None:
        """Log a failure; of several in a row only the first."""
        if not self._failed:
            log.error("%s: %s; it goes on, and further failures in a row are not logged", self._name, error)
        self._failed = True
