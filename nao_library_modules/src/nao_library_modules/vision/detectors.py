"""The robot's extractors that detect something, and the functions that see: ball, landmarks, codes, movement, faces."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from genpy import Time
from geometry_msgs.msg import Point
from std_msgs.msg import Header

from nao_library_msgs.msg import SeenObject
from naoqi.errors import NaoError, UnknownMethod

from ..core.chain import Part
from ..core.errors import did_you_mean
from ..core.geometry import FOOTPRINT
from ..core.memory_functions import MEMORY
from ..core.nao_facts import CAMERA_NAMES, RESOLUTIONS
from ..core.robot_events import Event, Events, ExtractorUse
from ..core.waiting import OncePerConnection
from ..motion.motion_plan import MOTION
from .cameras import CAMERAS, OPTICAL_FRAMES, VIDEO, Cameras, ChainResults
from .detections import (
    BALL,
    CODE,
    DEFAULT_SIZES,
    FACE,
    LANDMARK,
    MOVEMENT,
    NOTHING,
    Detection,
    DetectionArray,
    Lens,
    LocalizedDetection,
    Pose,
    Region,
    ball_detections,
    code_detections,
    face_detections,
    landmark_detections,
    located,
    merged,
    movement_detections,
)
from .vision_fields import (
    AnyCode,
    AnyMark,
    AnyPerson,
    BallSize,
    Camera,
    CodeSize,
    Confidence,
    DetectionTimeout,
    HeadSize,
    Looks,
    MarkSize,
    NameConfidence,
    Person,
    Sensitivity,
    camera_index,
    require_mark,
    require_name,
    timeout_of,
)

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic


log = logging.getLogger(__name__)

MOVEMENT_KEY = "MovementDetection/MovementInfo"
TORSO, ROBOT = 0, 2
"""NAOqi's FRAME_TORSO and FRAME_ROBOT."""


@dataclass(frozen=True)
class Detector:
    module: str
    event: str
    read: Callable[[Any], DetectionArray] | None = None
    """Reads the value of the event; None where that is not enough."""


DETECTORS = {
    BALL: Detector("ALRedBallDetection", "redBallDetected", ball_detections),
    FACE: Detector("ALFaceDetection", "FaceDetected", face_detections),
    LANDMARK: Detector("ALLandMarkDetection", "LandmarkDetected", landmark_detections),
    CODE: Detector("ALBarcodeReader", "BarcodeReader/BarcodeDetected"),
    MOVEMENT: Detector("ALMovementDetection", "MovementDetection/MovementDetected"),
}


@dataclass(frozen=True)
class WantedDetection:
    """What a function looks for."""

    kind: str  # ball, face, landmark, code or movement
    name: str = ""  # only the thing of this name; empty for all
    confidence: float = 0.0  # least confidence, 0..1; a face with less is unknown, anything else does not count
    size: float = 0.0  # real size, m; 0 for the usual one
    camera: int | None = None  # index of the camera; None for the active one

    def picks(self, detection: Detection) -> Detection | None:
        """A detection as it counts; None if it does not."""
        if detection.kind == FACE and detection.confidence < self.confidence:
            detection = replace(detection, name="")
        elif detection.confidence < self.confidence:
            return None
        return None if self.name and detection.name != self.name else detection


class InUse(NaoError):
    """An extractor works for others, and what a function needs would disturb them."""

    def __init__(self, module: str, others: Sequence[str], how: str) -> None:
        """Compose the text.

        `module`: NAOqi module. `others`: its other subscribers. `how`: what it does for them that would have to change.
        """
        super().__init__(f"{module} {how} for {', '.join(others)}: it cannot be changed while they need it")


class Watch:
    """An extractor that works for a function, as long as that needs it."""

    def __init__(self, detectors: Detectors, wanted: WantedDetection, events: Events, camera: int) -> None:
        self._detectors = detectors
        self._wanted = wanted
        self._events = events
        self._camera = camera  # index

    def until(self, end: float) -> Iterator[list[LocalizedDetection]]:
        """The detections that count, as they come: a list for each picture that has one, until a ROS time (s).

        Raises Preempted, or whatever reason the interrupt has; NaoError if the robot cannot be asked.
        """
        module = self._detectors.module
        for event in self._events.until(end):
            detections = self._detectors.placed(self._wanted, self._camera, event)
            if detections:
                first, seen = module.happened[0], detections[0].time
                module.happened = (first or seen, seen)
                yield detections


class Detectors(ExtractorUse):
    """The robot's extractors for the functions of NaoVision, and the robot's cameras that they look through."""

    def __init__(
        self, module: NaoBasic, cameras: Cameras, results: ChainResults, subscriber: str, frame_prefix: str
    ) -> None:
        """Take what a module offers.

        Args:
            cameras: Has the active camera.
            results: Gets what is seen.
            subscriber: Begin of the names of subscriptions: of each robot's clients no two have the same.
            frame_prefix: Prefix of the robot's frames, with its slash; may be empty.
        """
        super().__init__(module, subscriber)
        self.module = module
        self._cameras = cameras
        self._results = results
        self._prefix = frame_prefix
        self._lenses: OncePerConnection[dict[int, Lens]] = OncePerConnection(self.robot, dict)  # by camera

    @contextmanager
    def watching(self, wanted: WantedDetection) -> Iterator[Watch]:
        """Have an extractor work during a block."""
        detector = DETECTORS[wanted.kind]
        with self.looking_through(detector.module, wanted.camera) as camera, self.events_of(detector.event) as events:
            with self.subscribed(detector.module, wanted.kind):
                yield Watch(self, wanted, events, camera)

    def note(self, detections: Sequence[LocalizedDetection]) -> list[str]:
        """Put detections into the result; answers their labels."""
        self._results.objects += seen_messages(detections, self._prefix)
        return [detection.label for detection in detections]

    def publish_seen(self, status: str, detections: Sequence[LocalizedDetection] = ()) -> None:
        """Publish as feedback what is seen now, or was in the picture of these detections."""
        stamp = detections[0].time if detections else None
        self.module.publish_feedback(stamp=stamp, status=status, objects=seen_messages(detections, self._prefix))

    def placed(self, wanted: WantedDetection, camera: int, event: Event) -> list[LocalizedDetection]:
        """The detections of an event that count, and where they are.

        Args:
            wanted: What counts.
            camera: Index of the camera that the extractor looks through; detections of others do not count.
            event: Of the extractor.
        """
        try:
            array = self._read(wanted.kind, camera, event.value)
        except ValueError as error:
            log.warning("%s", error)
            return []
        if array.camera != camera or array.in_robot is None or array.in_torso is None:
            return []
        lens = self._lens(camera)
        # An event without the time of its picture counts from when it was raised.
        time = self.event_time(event) if array.time is None else self.robot_clock.ros_time(self.call, array.time)
        size = wanted.size or DEFAULT_SIZES.get(wanted.kind, 0.0)
        found = []
        for detection in filter(None, map(wanted.picks, array.detections)):
            region = detection.region or self._region(camera, detection)
            found.append(located(detection, camera, time, region, lens, size, array.in_torso, array.in_robot))
        return found

    def _read(self, kind: str, camera: int, value: Any) -> DetectionArray:
        read = DETECTORS[kind].read
        if read is not None:
            return read(value)
        if kind == MOVEMENT:
            return movement_detections(self.call(self.robot.proxy(MEMORY), "getData", MOVEMENT_KEY))
        if not value:
            return NOTHING
        resolution = int(self.call(self.robot.proxy(DETECTORS[CODE].module), "getResolution"))
        detections = code_detections(value, *_size(resolution), self._lens(camera))
        return DetectionArray(None, camera, self._pose(camera, TORSO), self._pose(camera, ROBOT), detections)

    # The robot's cameras

    @contextmanager
    def looking_through(self, module: str, wanted: int | None) -> Iterator[int]:
        """Have an extractor look through a camera during a block; its former camera comes back afterwards.

        Raises InUse if it looks through another camera for other subscribers.
        """
        owner = module
        try:
            now = int(self.call(self.robot.proxy(module), "getActiveCamera"))
        except UnknownMethod:  # it looks through the robot's active camera
            owner = VIDEO
            now = int(self.call(self.robot.proxy(VIDEO), "getActiveCamera"))
        camera = CAMERAS[self._cameras.active] if wanted is None else wanted
        if camera == now:
            yield now
            return
        others = self.others_of(module)
        if others:
            if wanted is None:
                yield now
                return
            raise InUse(module, others, f"looks through {CAMERA_NAMES[now]}")
        if self.begin(owner, "setActiveCamera", [camera], "setActiveCamera", now) is False:
            raise NaoError(f"{owner} cannot look through {CAMERA_NAMES[camera]}")
        proxy = self.robot.proxy(owner)
        with self.ended_by(lambda: self.call_now(proxy, "setActiveCamera", now), f"{owner} keeps its camera"):
            yield camera

    def others_of(self, module: str) -> list[str]:
        """Subscribers of an extractor that are not this server's."""
        subscribers = self.call(self.robot.proxy(module), "getSubscribersInfo")
        return [name for name, *_ in subscribers if not name.startswith(self.subscriber_for(""))]

    def _pose(self, camera: int, frame: int) -> Pose:
        position = self.call(self.robot.proxy(MOTION), "getPosition", CAMERA_NAMES[camera], frame, True)
        x, y, z, wx, wy, wz = map(float, position)
        return x, y, z, wx, wy, wz

    def _lens(self, camera: int) -> Lens:
        lenses = self._lenses()
        if camera not in lenses:
            proxy = self.robot.proxy(VIDEO)
            methods = ("getHorizontalFOV", "getVerticalFOV")
            lenses[camera] = Lens(*(float(self.call(proxy, method, camera)) for method in methods))
        return lenses[camera]

    def _region(self, camera: int, detection: Detection) -> Region:
        """Where a detection is in the picture, from the robot: angles of some detections are not all geometry's."""
        angles = [detection.alpha, detection.beta, detection.size_x, detection.size_y]
        numbers = self.call(self.robot.proxy(VIDEO), "getImageInfoFromAngularInfo", camera, angles)
        return Region(*map(float, numbers))


def _size(resolution: int) -> tuple[int, int]:
    for number, width, height in RESOLUTIONS.values():
        if number == resolution:
            return width, height
    raise ValueError(f"no resolution {resolution} is known")


def seen_messages(detections: Sequence[LocalizedDetection], prefix: str) -> list[SeenObject]:
    """Detections as messages; the prefix is that of the robot's frames, with its slash, or empty."""
    return [_seen_message(detection, prefix) for detection in detections]


def _seen_message(detection: LocalizedDetection, prefix: str) -> SeenObject:
    seen, region = detection.detection, detection.region
    camera = next(name for name, number in CAMERAS.items() if number == detection.camera)
    return SeenObject(
        header=Header(stamp=Time.from_sec(detection.time), frame_id=prefix + OPTICAL_FRAMES[camera]),
        kind=seen.kind,
        name=seen.name,
        confidence=seen.confidence,
        camera=camera,
        looks=detection.looks,
        alpha=seen.alpha,
        beta=seen.beta,
        size_x=seen.size_x,
        size_y=seen.size_y,
        heading=seen.heading,
        x=region.x,
        y=region.y,
        width=region.width,
        height=region.height,
        located=detection.distance is not None,
        distance=detection.distance or 0.0,
        camera_position=Point(*detection.in_optical),
        base_frame=prefix + FOOTPRINT,
        position=Point(*detection.in_robot),
        camera_origin=Point(*detection.camera_in_robot),
    )


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


FACES = DETECTORS[FACE].module


class FaceFunctions(Part):
    """Faces. Parameters are fields of VisionFunction. The robot keeps the faces that it learns."""

    def __init__(self, detectors: Detectors, detections: DetectionFunctions) -> None:
        self._detectors = detectors
        self._detections = detections

    def detect_faces(
        self,
        str_param: AnyPerson,
        camera: Camera,
        timeout: DetectionTimeout,
        confidence: NameConfidence,
        count: Looks,
        size: HeadSize,
    ) -> list[str]:
        """See faces; answers whose they are, "face" for each that nobody knows."""
        wanted = WantedDetection(FACE, str_param.strip(), confidence, size, camera_index(camera))
        return self._detections.detect(wanted, timeout, count)

    def learn_face(self, str_param: Person, camera: Camera, timeout: DetectionTimeout) -> list[bool]:
        """Learn the face that is in view under a name; answers whether there was one, alone, that could be learnt."""
        name = require_name(str_param)
        if name in self.list_faces():
            raise NaoError(f"the face of {name!r} is learnt already: reLearnFace adds to it, forgetFace forgets it")
        return self._learn("learnFace", name, camera, timeout)

    def relearn_face(self, str_param: Person, camera: Camera, timeout: DetectionTimeout) -> list[bool]:
        """Add the face that is in view to what is known of a person; answers as learnFace does."""
        name = self._known_person(str_param)
        return self._learn("reLearnFace", name, camera, timeout)

    def forget_face(self, str_param: Person) -> None:
        """Forget a person's face."""
        name = self._known_person(str_param)
        if not self._call("forgetPerson", name):
            raise NaoError(f"{FACES} did not forget the face of {name!r}")

    def forget_all_faces(self) -> None:
        """Forget all faces."""
        if not self._call("clearDatabase"):
            raise NaoError(f"{FACES} did not forget the faces")

    def list_faces(self) -> list[str]:
        """Whose faces are learnt."""
        return [str(name) for name in self._call("getLearnedFacesList")]

    def _call(self, method: str, *args: Any) -> Any:
        return self._detectors.call(self._detectors.robot.proxy(FACES), method, *args)

    def _known_person(self, str_param: str) -> str:
        name, known = require_name(str_param), self.list_faces()
        if name not in known:
            learnt = f"learnt are {', '.join(known)}" if known else "none is learnt"
            raise NaoError(f"no face of {name!r} is learnt{did_you_mean(name, known)}: {learnt}")
        return name

    def _learn(self, method: str, name: str, camera: str, timeout: float) -> list[bool]:
        detectors = self._detectors
        detectors.publish_seen("looking")
        with detectors.watching(WantedDetection(FACE, camera=camera_index(camera))) as watch:
            for detections in watch.until(detectors.clock.now() + timeout_of(timeout)):
                detectors.publish_seen("looking", detections)
                # The robot does not say which of several faces it would learn.
                if len(detections) == 1 and self._call(method, name):
                    (face,) = detections
                    detectors.note([replace(face, detection=replace(face.detection, name=name))])
                    return [True]
        return [False]

    functions = {
        "detectFaces": detect_faces,
        "learnFace": learn_face,
        "reLearnFace": relearn_face,
        "forgetFace": forget_face,
        "forgetPerson": forget_face,
        "forgetAllFaces": forget_all_faces,
        "clearDatabase": forget_all_faces,
        "listFaces": list_faces,
        "getLearnedFaces": list_faces,
        "getLearnedFacesList": list_faces,
    }
