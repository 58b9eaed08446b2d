"""What the groups of seeing functions share: having the robot's extractors look, and placing what they see."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

from naoqi.errors import NaoError

from ...functions.memory_functions import MEMORY
from ...nao.camera_facts import RESOLUTIONS
from ...server.extractor_use import Event, Events
from ..capture.fields import DEFAULT_TIMEOUT
from .cameras import ROBOT, TORSO, CameraAccess
from .events import (
    BALL,
    CODE,
    FACE,
    LANDMARK,
    MOVEMENT,
    NOTHING,
    Detection,
    DetectionArray,
    ball_detections,
    code_detections,
    face_detections,
    landmark_detections,
    movement_detections,
)
from .results import Seen, seen_messages
from .space import DEFAULT_SIZES, LocalizedDetection, located

log = logging.getLogger(__name__)

MOVEMENT_KEY = "MovementDetection/MovementInfo"


@dataclass(frozen=True)
class Detector:
    """One of the robot's extractors.

    Attributes:
        module: Its NAOqi module.
        event: The event that it raises.
        read: What its event says; None where more is needed than its value.
    """

    module: str
    event: str
    read: Callable[[Any], DetectionArray] | None = None


DETECTORS = {
    BALL: Detector("ALRedBallDetection", "redBallDetected", ball_detections),
    FACE: Detector("ALFaceDetection", "FaceDetected", face_detections),
    LANDMARK: Detector("ALLandMarkDetection", "LandmarkDetected", landmark_detections),
    CODE: Detector("ALBarcodeReader", "BarcodeReader/BarcodeDetected"),
    MOVEMENT: Detector("ALMovementDetection", "MovementDetection/MovementDetected"),
}


@dataclass(frozen=True)
class Wanted:
    """What a function looks for.

    Attributes:
        kind: ball, face, landmark, code or movement.
        name: Only the thing of this name; empty for all.
        confidence: 0..1, with less it does not count; a face with less is somebody unknown.
        size: m, its real size; 0 for the usual one.
        camera: Index of the camera; None for the active one.
    """

    kind: str
    name: str = ""
    confidence: float = 0.0
    size: float = 0.0
    camera: int | None = None

    def picks(self, detection: Detection) -> Detection | None:
        """A detection as it counts; None if it does not."""
        if detection.kind == FACE and detection.confidence < self.confidence:
            detection = replace(detection, name="")
        elif detection.confidence < self.confidence:
            return None
        return None if self.name and detection.name != self.name else detection


class Watch:
    """An extractor that works for a function, as long as that needs it."""

    def __init__(self, base: DetectionBase, wanted: Wanted, events: Events, camera: int) -> None:
        """Begin.

        Args:
            base: Reaches the robot.
            wanted: What counts.
            events: Those of the extractor.
            camera: Index of the camera that it looks through.
        """
        self._base = base
        self._wanted = wanted
        self._events = events
        self._camera = camera

    def until(self, end: float) -> Iterator[list[LocalizedDetection]]:
        """What pictures show, as they come: one list for each picture with something that counts.

        Args:
            end: ROS time of the end, s.

        Raises:
            Preempted: Or whatever reason the interrupt has.
            NaoError: If the robot cannot be asked.
        """
        for event in self._events.until(end):
            detections = self._base.placed(self._wanted, self._camera, event)
            if detections:
                first, seen = self._base.happened[0], detections[0].time
                self._base.happened = (first or seen, seen)
                yield detections


class DetectionBase(CameraAccess):
    """To be mixed into NaoBasic.

    Attributes:
        seen: What the chain saw so far; new for each goal.
        frame_prefix: Prefix of the robot's frames, with its slash; may be empty.
    """

    seen: Seen
    frame_prefix: str
    tell: Callable[..., None]  # of NaoVision: feedback
    remark: Callable[[str], None]  # of NaoBasic
    happened: tuple[float, float]  # of NaoBasic: times of the first and the last picture in which something counts

    @contextmanager
    def watching(self, wanted: Wanted) -> Iterator[Watch]:
        """Have an extractor look during a block."""
        detector = DETECTORS[wanted.kind]
        with self.looking_through(detector.module, wanted.camera) as camera, self.events_of(detector.event) as events:
            with self.subscribed(detector.module, wanted.kind):
                yield Watch(self, wanted, events, camera)

    def note(self, detections: Sequence[LocalizedDetection]) -> list[str]:
        """Put what was seen into the result; answers what it is called, one text each."""
        self.seen.objects += seen_messages(detections, self.frame_prefix)
        return [detection.label for detection in detections]

    def tell_seen(self, status: str, detections: Sequence[LocalizedDetection] = ()) -> None:
        """Publish what is seen now, or was in the picture of these detections."""
        stamp = detections[0].time if detections else None
        self.tell(status, seen_messages(detections, self.frame_prefix), stamp=stamp)

    def placed(self, wanted: Wanted, camera: int, event: Event) -> list[LocalizedDetection]:
        """What counts of an event, and where it is.

        Args:
            wanted: What counts.
            camera: Index of the camera that the extractor looks through; what others see does not count.
            event: Of the extractor.
        """
        try:
            look = self._look(wanted.kind, camera, event.value)
        except ValueError as error:
            log.warning("%s", error)
            return []
        if look.camera != camera or look.in_robot is None or look.in_torso is None:
            return []
        lens, time = self.lens(camera), self._time(look, event)
        size = wanted.size or DEFAULT_SIZES.get(wanted.kind, 0.0)
        found = []
        for detection in filter(None, map(wanted.picks, look.detections)):
            region = detection.region or self.region(camera, detection)
            found.append(located(detection, camera, time, region, lens, size, look.in_torso, look.in_robot))
        return found

    def end_leftover_detections(self) -> bool:
        """End what a server of this name could not end, for it was killed; tells whether the robot was asked."""
        for detector in DETECTORS.values():
            try:
                proxy = self.robot.proxy(detector.module)
                for name, *_ in self.call_now(proxy, "getSubscribersInfo"):
                    if name.startswith(self.subscriber_for("")):
                        self.call_now(proxy, "unsubscribe", name)
            except NaoError as error:
                log.debug("%s may work for nobody: %s", detector.module, error)
        return self.robot.connection.state == "connected"

    def _look(self, kind: str, camera: int, value: Any) -> DetectionArray:
        read = DETECTORS[kind].read
        if read is not None:
            return read(value)
        if kind == MOVEMENT:
            return movement_detections(self.call(self.robot.proxy(MEMORY), "getData", MOVEMENT_KEY))
        if not value:
            return NOTHING
        resolution = int(self.call(self.robot.proxy(DETECTORS[CODE].module), "getResolution"))
        detections = code_detections(value, *_size(resolution), self.lens(camera))
        return DetectionArray(
            None, camera, self.camera_pose(camera, TORSO), self.camera_pose(camera, ROBOT), detections
        )

    def _time(self, look: DetectionArray, event: Event) -> float:
        """ROS time of a picture, s; of one whose time is not told that at which its event was raised."""
        if look.time is None:
            return self.event_time(event)
        return self.robot_clock.ros_time(self.call, look.time)


def timeout_of(timeout: float) -> float:
    """How long a function waits, s."""
    return timeout or DEFAULT_TIMEOUT


def _size(resolution: int) -> tuple[int, int]:
    for number, width, height in RESOLUTIONS.values():
        if number == resolution:
            return width, height
    raise ValueError(f"no resolution {resolution} is known")
