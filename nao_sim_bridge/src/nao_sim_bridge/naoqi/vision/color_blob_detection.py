"""ALColorBlobDetection of the simulated robot."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.settings import AUTO_EXPOSURE
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.arguments import number, one_of, whole_number
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.names import COLOR_BLOB, COLOR_BLOBS
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.tracking.geometry import distance_of, seen_place
from nao_sim_bridge.vision.client import VisionProcess
from nao_sim_bridge.vision.color_blob import Blob, BlobSettings

FPS = 15
CIRCLE, UNKNOWN = SHAPES = ("Circle", "Unknown")
DEFAULT_PIXELS, DEFAULT_SPAN = 16, 0.06
MOST_PIXELS = 2560 * 1920
LEAST_SPAN, MOST_SPAN = 0.005, 5.0


class ALColorBlobDetection:
    """Tells where the largest blob of a colour is. Only NAOqi methods are public, `watching` and `close`.

    With each picture that shows one it raises `ALTracker/ColorBlobDetected`, which ALTracker.trackEvent follows: [place
    in FRAME_TORSO, place in FRAME_ROBOT, [seconds, microseconds], effector], places as [x, y, z, 0, 0, 0] in m, by the
    span of the object, effector 1 for the top camera and 2 for the bottom one. Nothing is found before `setColor`.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> None:
        self._cameras = simulation.cameras
        self._memory = memory
        self._looks_for: BlobSettings | None = None
        self._pixels, self._span, self._shape = DEFAULT_PIXELS, DEFAULT_SPAN, UNKNOWN
        self._blob: Blob | None = None
        self.watching = Watching(
            self._cameras,
            COLOR_BLOBS,
            vision.detector("color blob"),
            self._on_result,
            settings=lambda _: self._looks_for,
            on_stop=self._nothing,
            fps=FPS,
        )

    def setColor(self, red: int, green: int, blue: int, threshold: int) -> None:
        parts = {"r": red, "g": green, "b": blue, "colorThres": threshold}
        red, green, blue, threshold = (whole_number(value, field, 0, 255) for field, value in parts.items())
        self._looks_for = BlobSettings((red, green, blue), threshold, self._pixels, self._shape == CIRCLE)

    def setObjectProperties(self, least_pixels: int, span: float, shape: str = UNKNOWN) -> None:
        """`least_pixels` of the blob, the width of the object in m, and whether it is round."""
        pixels = whole_number(least_pixels, "minSize", 1, MOST_PIXELS)
        wide = number(span, "span", LEAST_SPAN, MOST_SPAN)
        self._shape = one_of(shape, "shape", SHAPES)
        self._pixels, self._span = pixels, wide
        if self._looks_for is not None:
            self._looks_for = replace(self._looks_for, least_pixels=pixels, round=shape == CIRCLE)

    def getCircle(self) -> list[float]:
        """[x, y, radius] around the blob of the last picture, x and radius as shares of its width; [] without one."""
        blob = self._blob
        return [] if blob is None else [blob.x, blob.y, blob.radius]

    def getAutoExposure(self) -> bool:
        return bool(self._cameras.parameter(self.watching.camera, AUTO_EXPOSURE))

    def setAutoExposure(self, mode: bool) -> None:
        self._cameras.set_parameter(self.watching.camera, AUTO_EXPOSURE, int(mode))

    def close(self) -> None:
        self.watching.stop()

    def _on_result(self, frame: Frame, blob: Blob | None) -> None:
        self._blob = blob
        if blob is not None:
            self._memory.raise_event(COLOR_BLOB, self._value(frame, blob))

    def _value(self, frame: Frame, blob: Blob) -> list[Any]:
        distance = distance_of(self._span, 2.0 * blob.angle)
        poses = (frame.pose_in_torso, frame.pose_in_robot)
        places = [[*seen_place(pose, blob.alpha, blob.beta, distance), 0.0, 0.0, 0.0] for pose in poses]
        return [*places, list(frame.stamp), frame.camera + 1]

    def _nothing(self) -> None:
        self._blob = None
