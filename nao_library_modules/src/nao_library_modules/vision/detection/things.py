"""Functions that see things: the ball, landmarks, codes, and what moves."""

from __future__ import annotations

from ..capture.fields import Camera
from .base import DETECTORS, DetectionBase, Wanted, timeout_of
from .cameras import InUse
from .events import BALL, CODE, LANDMARK, MOVEMENT
from .fields import AnyCode, AnyMark, BallSize, CodeSize, Confidence, Looks, MarkSize, Sensitivity, Timeout
from .goals import camera_index, require_mark
from .space import merged

TYPED: frozenset[str] = frozenset()
"""Functions here whose answers stay out of memList: none, the names of what was seen are for both."""


class DetectionFunctions(DetectionBase):
    """Detections. Parameters are fields of VisionFunction. Nothing seen in time is an answer, too."""

    def detect_ball(
        self, camera: Camera, timeout: Timeout, confidence: Confidence, count: Looks, size: BallSize
    ) -> list[str]:
        """See a red ball."""
        return self.detect(Wanted(BALL, "", confidence, size, camera_index(camera)), timeout, count)

    def detect_landmarks(
        self, str_param: AnyMark, camera: Camera, timeout: Timeout, confidence: Confidence, count: Looks, size: MarkSize
    ) -> list[str]:
        """See landmarks; answers their numbers."""
        wanted = Wanted(LANDMARK, require_mark(str_param), confidence, size, camera_index(camera))
        return self.detect(wanted, timeout, count)

    def read_barcodes(
        self, str_param: AnyCode, camera: Camera, timeout: Timeout, confidence: Confidence, count: Looks, size: CodeSize
    ) -> list[str]:
        """Read barcodes and QR codes; answers what they say."""
        return self.detect(Wanted(CODE, str_param, confidence, size, camera_index(camera)), timeout, count)

    def detect_movement(
        self, camera: Camera, timeout: Timeout, confidence: Confidence, count: Looks, sensitivity: Sensitivity
    ) -> list[str]:
        """See what moves."""
        wanted = Wanted(MOVEMENT, "", confidence, 0.0, camera_index(camera))
        if sensitivity <= 0.0:
            return self.detect(wanted, timeout, count)
        module = DETECTORS[MOVEMENT].module
        proxy = self.robot.proxy(module)
        before = float(self.call(proxy, "getColorSensitivity"))
        others = self.others_of(module)
        if others:
            raise InUse(module, others, f"has the sensitivity {before:g}")
        self.begin(module, "setColorSensitivity", [float(sensitivity)], "setColorSensitivity", before)
        with self.ended_by(
            lambda: self.call_now(proxy, "setColorSensitivity", before), f"{module} keeps its sensitivity"
        ):
            return self.detect(wanted, timeout, count)

    def detect(self, wanted: Wanted, timeout: float, count: int) -> list[str]:
        """Look until something was seen often enough, or the time is over.

        Args:
            wanted: What counts.
            timeout: s; 0 for the default.
            count: In how many pictures something is to be seen; 0 for one.

        Returns:
            What the things that were seen are called.
        """
        pictures = []
        self.tell_seen("looking")
        with self.watching(wanted) as watch:
            for detections in watch.until(self.clock.now() + timeout_of(timeout)):
                pictures.append(detections)
                self.tell_seen("looking", detections)
                if len(pictures) >= max(count, 1):
                    break
        if not pictures:
            self.remark(f"no {wanted.kind} seen within {timeout_of(timeout):g} s")
        # Nobody can tell which movement of one picture is which of the next.
        return self.note(merged(pictures[-1:] if wanted.kind == MOVEMENT else pictures))

    functions = {
        "detectBall": detect_ball,
        "detectLandmarks": detect_landmarks,
        "readBarcodes": read_barcodes,
        "detectMovement": detect_movement,
    }
