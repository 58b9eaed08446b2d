"""Functions that see things: the ball, landmarks, codes, and what moves."""

from __future__ import annotations

from ...functions.parts import Part
from ..capture.fields import Camera
from .detectors import DETECTORS, Detectors, InUse, WantedDetection
from .events import BALL, CODE, LANDMARK, MOVEMENT
from .fields import (
    AnyCode,
    AnyMark,
    BallSize,
    CodeSize,
    Confidence,
    DetectionTimeout,
    Looks,
    MarkSize,
    Sensitivity,
    camera_index,
    require_mark,
    timeout_of,
)
from .space import merged


class DetectionFunctions(Part):
    """Detections. Parameters are fields of VisionFunction. Nothing seen in time is an answer, too."""

    def __init__(self, detectors: Detectors) -> None:
        self._detectors = detectors

    def detect_ball(
        self, camera: Camera, timeout: DetectionTimeout, confidence: Confidence, count: Looks, size: BallSize
    ) -> list[str]:
        """See a red ball."""
        return self.detect(WantedDetection(BALL, "", confidence, size, camera_index(camera)), timeout, count)

    def detect_landmarks(
        self,
        str_param: AnyMark,
        camera: Camera,
        timeout: DetectionTimeout,
        confidence: Confidence,
        count: Looks,
        size: MarkSize,
    ) -> list[str]:
        """See landmarks; answers their numbers."""
        wanted = WantedDetection(LANDMARK, require_mark(str_param), confidence, size, camera_index(camera))
        return self.detect(wanted, timeout, count)

    def read_barcodes(
        self,
        str_param: AnyCode,
        camera: Camera,
        timeout: DetectionTimeout,
        confidence: Confidence,
        count: Looks,
        size: CodeSize,
    ) -> list[str]:
        """Read barcodes and QR codes; answers what they say."""
        return self.detect(WantedDetection(CODE, str_param, confidence, size, camera_index(camera)), timeout, count)

    def detect_movement(
        self, camera: Camera, timeout: DetectionTimeout, confidence: Confidence, count: Looks, sensitivity: Sensitivity
    ) -> list[str]:
        """See what moves."""
        wanted = WantedDetection(MOVEMENT, "", confidence, 0.0, camera_index(camera))
        if sensitivity <= 0.0:
            return self.detect(wanted, timeout, count)
        detectors, module = self._detectors, DETECTORS[MOVEMENT].module
        proxy = detectors.robot.proxy(module)
        before = float(detectors.call(proxy, "getColorSensitivity"))
        others = detectors.others_of(module)
        if others:
            raise InUse(module, others, f"has the sensitivity {before:g}")
        detectors.begin(module, "setColorSensitivity", [float(sensitivity)], "setColorSensitivity", before)
        with detectors.ended_by(
            lambda: detectors.call_now(proxy, "setColorSensitivity", before), f"{module} keeps its sensitivity"
        ):
            return self.detect(wanted, timeout, count)

    def detect(self, wanted: WantedDetection, timeout: float, count: int) -> list[str]:
        """Look until something was seen in so many pictures (0: one) or the timeout (s) is over; answers labels."""
        detectors, pictures = self._detectors, []
        detectors.publish_seen("looking")
        with detectors.watching(wanted) as watch:
            for detections in watch.until(detectors.clock.now() + timeout_of(timeout)):
                pictures.append(detections)
                detectors.publish_seen("looking", detections)
                if len(pictures) >= max(count, 1):
                    break
        if not pictures:
            detectors.module.remark(f"no {wanted.kind} seen within {timeout_of(timeout):g} s")
        # Movements of one picture cannot be matched with those of the next.
        return detectors.note(merged(pictures[-1:] if wanted.kind == MOVEMENT else pictures))

    functions = {
        "detectBall": detect_ball,
        "detectLandmarks": detect_landmarks,
        "readBarcodes": read_barcodes,
        "detectMovement": detect_movement,
    }
