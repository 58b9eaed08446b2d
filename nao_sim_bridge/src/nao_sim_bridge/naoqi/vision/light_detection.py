"""ALDarknessDetection and ALBacklightingDetection of the simulated robot."""

from __future__ import annotations

from nao_sim_bridge.cameras.automatics import Exposure
from nao_sim_bridge.cameras.cameras import Cameras
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.settings import EXPOSURE, GAIN
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.names import (
    BACKLIGHT,
    BACKLIGHT_VALUE,
    BACKLIGHTING,
    DARK,
    DARKNESS,
    DARKNESS_VALUE,
)
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.client import VisionProcess
from nao_sim_bridge.vision.light import BACKLIT, DARKEST

FPS = 5
QQVGA = 0
"""Enough to tell how bright a picture is."""
DEFAULT_THRESHOLD = 60


def exposed(cameras: Cameras, frame: Frame) -> float:
    """How many times as bright as in a well-lit room a camera has made its last picture."""
    exposure, gain = (cameras.parameter(frame.camera, number) for number in (EXPOSURE, GAIN))
    return Exposure(exposure, gain).brightness(cameras.tables.sensor)


class ALDarknessDetection:
    """Tells when it gets dark. Only NAOqi methods are public, `watching` and `close`.

    With each picture it writes `DarknessDetection/DarknessValue`, 0 bright to 100 dark; when that has risen above the
    threshold it raises `DarknessDetection/DarknessDetected` with it, once. Exposure and gain of the camera are allowed
    for: that the automatic brightens the picture of a dark room makes it no brighter.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> None:
        self._cameras = simulation.cameras
        self._memory = memory
        self._threshold = DEFAULT_THRESHOLD
        self._dark = False
        self.watching = Watching(
            self._cameras,
            DARKNESS,
            vision.detector("darkness"),
            self._on_result,
            settings=lambda frame: exposed(self._cameras, frame),
            on_stop=self._nothing,
            resolution=QQVGA,
            fps=FPS,
        )
        memory.insert(DARKNESS_VALUE, 0)

    def getDarknessThreshold(self) -> int:
        return self._threshold

    def setDarknessThreshold(self, threshold: int) -> None:
        """What is out of range is the end of it that is nearer."""
        self._threshold = min(max(threshold, 0), DARKEST)

    def close(self) -> None:
        self.watching.stop()

    def _on_result(self, _: Frame, darkness: int) -> None:
        self._memory.insert(DARKNESS_VALUE, darkness)
        before, self._dark = self._dark, darkness > self._threshold
        if self._dark and not before:
            self._memory.raise_event(DARK, darkness)

    def _nothing(self) -> None:
        self._dark = False


class ALBacklightingDetection:
    """Tells when pictures get backlit. Only `watching` and `close` are public: NAOqi has no methods of its own for it.

    With each picture it writes `BacklightingDetection/BacklightingValue`, 0 not backlit, 1 possibly, 2 surely; when
    that has become 2 it raises `BacklightingDetection/BacklightingDetected`, without a value, once.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> None:
        self._memory = memory
        self._value = 0
        self.watching = Watching(
            simulation.cameras,
            BACKLIGHTING,
            vision.detector("backlighting"),
            self._on_result,
            on_stop=self._nothing,
            resolution=QQVGA,
            fps=FPS,
        )
        memory.insert(BACKLIGHT_VALUE, 0)

    def close(self) -> None:
        self.watching.stop()

    def _on_result(self, _: Frame, value: int) -> None:
        self._memory.insert(BACKLIGHT_VALUE, value)
        before, self._value = self._value, value
        if value == BACKLIT and before != BACKLIT:
            self._memory.raise_event(BACKLIGHT, None)

    def _nothing(self) -> None:
        self._value = 0
