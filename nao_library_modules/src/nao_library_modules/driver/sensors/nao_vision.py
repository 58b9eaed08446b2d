"""The node nao_vision: faces, landmarks and movement that the robot detects."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Tuple

import rospy
from geometry_msgs.msg import Point
from rospy.rostime import is_wallclock
from std_msgs.msg import Float32, Header, Int32
from std_srvs.srv import Empty

from nao_library_msgs.msg import FaceDetected, LandmarkDetected, MovementDetected
from nao_library_msgs.srv import LearnFace, LearnFaceResponse, VisionMotionSensitivity
from naoqi.errors import BadArguments, NaoError, UnknownMethod
from naoqi.limits import LEARN_LIMIT

from ...core.health import Report
from ...core.nao_facts import CAMERA_NAMES, TOP, camera_number
from ...core.robot_events import ImageClock
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import pose_of, tf_prefix
from ...vision.detections import Detection, DetectionArray, face_detections, landmark_detections, movement_detections
from ..base.driver_node import name_for_robot, publish
from ..base.lazy_subscription import Extractor, ExtractorKind
from ..camera.camera_images import header_of

log = logging.getLogger(__name__)

Pair = Tuple[float, float]

EYE = (
    "eyeCenter",
    "noseSideLimit",
    "earSideLimit",
    "topLimit",
    "bottomLimit",
    "midTopEarLimit",
    "midTopNoseLimit",
)
EYEBROW = ("noseSideLimit", "center", "earSideLimit")
NOSE = ("bottomCenterLimit", "bottomLeftLimit", "bottomRightLimit")
MOUTH = (
    "leftLimit",
    "rightLimit",
    "topLimit",
    "bottomLimit",
    "midTopLeftLimit",
    "midTopRightLimit",
    "midBottomRightLimit",
    "midBottomLeftLimit",
)
PARTS = (
    ("left_eye", EYE),
    ("right_eye", EYE),
    ("left_eyebrow", EYEBROW),
    ("right_eyebrow", EYEBROW),
    ("nose", NOSE),
    ("mouth", MOUTH),
)
"""Parts of a face and their points, in the order of the event; message fields are named after them."""
LONGEST_STEP = 0.5
"""s between two events above which velocities are unknown."""
NO_POSE = (0.0,) * 6
"""Stands for a pose of the camera that an event does not contain."""


@dataclass(frozen=True)
class Face:
    """A face."""

    shape: Detection
    number: int
    score: float  # of the recognition, 0 to 1
    label: str  # name of the person; empty if not known
    points: dict[str, Pair]  # "left_eye_eyeCenter" and so on -> alpha, beta in rad; without those not reported


@dataclass(frozen=True)
class Movement:
    """Movement in a picture; positions are alpha, beta in rad, velocities in rad/s."""

    view: DetectionArray | None  # None if the robot does not report it
    centre: Pair  # mean
    velocity: Pair  # mean
    points: tuple[Pair, ...]  # of each part that moved
    velocities: tuple[Pair, ...]  # of the same parts


def _seen(read: Callable[[Any], DetectionArray], value: Any) -> DetectionArray | None:
    """The detections of an event, which may lack time, poses or camera; None if it has none, or is no such event."""
    if not _is_list(value, 2):
        return None
    stamp = value[0] if _is_list(value[0], 2) else (0, 0)
    in_torso, in_robot = (value[i] if len(value) > i and _is_list(value[i], 6) else NO_POSE for i in (2, 3))
    camera = value[4] if len(value) > 4 and camera_number(value[4]) is not None else TOP
    try:
        seen = read([stamp, value[1], in_torso, in_robot, camera])
    except ValueError as error:
        log.debug("%s", error)
        return None
    return seen if seen.detections else None


def read_faces(value: Any) -> tuple[DetectionArray, list[Face]] | None:
    """Faces of an event, as `face_detections` describes it; None if there are none."""
    seen = _seen(face_detections, value)
    if seen is None:
        return None
    # Behind the faces comes what the recognition found over time: that has no shape.
    extras = [each[1] for each in value[1] if len(each) == 2 and _is_list(each[0], 0)]
    return seen, [_face(shape, extra) for shape, extra in zip(seen.detections, extras)]


def read_landmarks(value: Any) -> DetectionArray | None:
    """Landmarks of an event, as `landmark_detections` describes it; None if there are none."""
    return _seen(landmark_detections, value)


class MovementReader:
    """Reads movements, and computes velocities from one to the next. For one thread."""

    def __init__(self) -> None:
        self._last: tuple[float, tuple[Pair, ...], Pair] | None = None

    def read(self, value: Any) -> Movement | None:
        """Movement from the value in the robot's memory, as `movement_detections` describes it; None if there is none.

        NAOqi before 2.0 has [[centre, velocity, [point, ...], [velocity, ...]]] instead; that is read, too.
        """
        if _is_list(value, 1) and _is_list(value[0], 4):
            return _former_movement(value[0])
        view = _seen(movement_detections, value)
        if view is None:
            return None
        points = tuple((each.alpha, each.beta) for each in view.detections)
        centre = _centre(points, [_extent(each) for each in value[1]])
        velocity, velocities = self._velocities(view.time, points, centre)
        self._last = (view.time, points, centre)
        return Movement(view, centre, velocity, points, velocities)

    def _velocities(self, time: float, points: tuple[Pair, ...], centre: Pair) -> tuple[Pair, tuple[Pair, ...]]:
        """Mean velocity and those of the points, rad/s: 0 where there was nothing shortly before."""
        still = (0.0, 0.0)
        step = time - self._last[0] if self._last is not None else 0.0
        if self._last is None or not 0.0 < step <= LONGEST_STEP:
            return still, (still,) * len(points)
        _, former, former_centre = self._last
        nearest = (min(former, key=lambda each, point=point: math.dist(each, point)) for point in points)
        velocities = tuple(_velocity(begin, end, step) for begin, end in zip(nearest, points))
        return _velocity(former_centre, centre, step), velocities


def _velocity(begin: Pair, end: Pair, step: float) -> Pair:
    return (end[0] - begin[0]) / step, (end[1] - begin[1]) / step


def _extent(cluster: Sequence[Any]) -> float:
    """Size of a cluster in the picture, in any unit."""
    region = cluster[1]
    share = 1.0 if _is_list(cluster[2], 0) else float(cluster[2])
    return abs(float(region[-2]) * float(region[-1])) * share


def _centre(points: Sequence[Pair], weights: Sequence[float]) -> Pair:
    total = sum(weights)
    if total <= 0.0:
        weights, total = [1.0] * len(points), float(len(points))
    return (
        sum(point[0] * weight for point, weight in zip(points, weights)) / total,
        sum(point[1] * weight for point, weight in zip(points, weights)) / total,
    )


def _former_movement(entry: Sequence[Any]) -> Movement:
    centre, velocity = _pair(entry[0]), _pair(entry[1])
    return Movement(None, centre, velocity, tuple(map(_pair, entry[2])), tuple(map(_pair, entry[3])))


def _face(shape: Detection, extra: Sequence[Any]) -> Face:
    number, score, label = extra[:3]
    points = {}
    for (part, names), values in zip(PARTS, extra[3:]):
        if _is_list(values, 2):
            pairs = zip(names, zip(values[::2], values[1::2]))
            points.update({f"{part}_{name}": (float(x), float(y)) for name, (x, y) in pairs})
    return Face(shape, int(number), float(score), str(label), points)


def _pair(value: Sequence[Any]) -> Pair:
    return float(value[0]), float(value[1])


def _is_list(value: Any, least: int) -> bool:
    return isinstance(value, (list, tuple)) and len(value) >= least


def to_face(face: Face, view: DetectionArray, header: Header) -> FaceDetected:
    """A face; points that the robot does not report are 0."""
    message = FaceDetected(header=header)
    message.face_id.data, message.score_reco.data, message.face_label.data = face.number, face.score, face.label
    message.shape_alpha.data, message.shape_beta.data = face.shape.alpha, face.shape.beta
    message.shape_sizeX.data, message.shape_sizeY.data = face.shape.size_x, face.shape.size_y
    for name, (x, y) in face.points.items():
        getattr(message, f"{name}_x").data, getattr(message, f"{name}_y").data = x, y
    message.camera_0_pose, message.camera_1_pose = pose_of(view.in_torso), pose_of(view.in_robot)
    message.camera_id.data = view.camera
    return message


def to_landmarks(seen: DetectionArray, header: Header) -> LandmarkDetected:
    message = LandmarkDetected(header=header)
    message.mark_ids = [Int32(int(mark.name)) for mark in seen.detections]
    message.shape_alpha = [Float32(mark.alpha) for mark in seen.detections]
    message.shape_beta = [Float32(mark.beta) for mark in seen.detections]
    message.shape_sizex = [Float32(mark.size_x) for mark in seen.detections]
    message.shape_sizey = [Float32(mark.size_y) for mark in seen.detections]
    message.camera_local_pose, message.camera_world_pose = pose_of(seen.in_torso), pose_of(seen.in_robot)
    message.camera_name.data = CAMERA_NAMES[seen.camera]
    return message


def to_movement(movement: Movement, header: Header) -> MovementDetected:
    """A movement; angles are x and y of the points, z is 0."""
    return MovementDetected(
        header=header,
        gravity_center=Point(*movement.centre, 0.0),
        mean_velocity=Point(*movement.velocity, 0.0),
        points_poses=[Point(*each, 0.0) for each in movement.points],
        points_speeds=[Point(*each, 0.0) for each in movement.velocities],
    )


FACES = ExtractorKind("face detection", "ALFaceDetection", "FaceDetected")
LANDMARKS = ExtractorKind("landmark detection", "ALLandMarkDetection", "LandmarkDetected")
MOVEMENT = ExtractorKind(
    "motion detection",
    "ALMovementDetection",
    "MovementDetection/MovementDetected",
    "MovementDetection/MovementInfo",
)
QUEUE = 10


class NaoVisionServices:
    """What the vision modules of one robot find, under the names of nao_interaction.

    What is switched on is switched on again on a robot that was lost, and off when the node ends. What goes wrong is
    the error of the service that was called: the others continue.

    ROS API (relative names):
        Services `nao_vision/face_detection/enable`, `.../disable`, `nao_vision/motion_detection/enable`,
        `.../disable`, `nao_vision/landmark_detection/enable`, `.../disable` (std_srvs/Empty; a second time without
        effect), `nao_vision/face_detection/learn_face`, `nao_vision/face_detection/forget_person`
        (nao_library_msgs/LearnFace), `nao_vision/movement_detection_sensitivity`
        (nao_library_msgs/VisionMotionSensitivity; 0 to 1, 1: small movements are found as well).
        Publishes `nao_vision/faces_detected` (nao_library_msgs/FaceDetected, one a face),
        `nao_vision/movement_detected` (nao_library_msgs/MovementDetected), `nao_vision/landmark_detected`
        (nao_library_msgs/LandmarkDetected). The frame of the header is the optical frame of the camera that saw it,
        the stamp that of its picture.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        subscriber = name_for_robot(self._node.name)
        self._prefix = tf_prefix()
        self._sensitivity: float | None = None
        self._lock = threading.Lock()  # events come in several threads of libqi
        self._clocks = {kind: ImageClock() for kind in (FACES, LANDMARKS, MOVEMENT)}
        self._movements = MovementReader()
        self._faces_topic = self._topic("faces_detected", FaceDetected)
        self._landmarks_topic = self._topic("landmark_detected", LandmarkDetected)
        self._movement_topic = self._topic("movement_detected", MovementDetected)
        self._faces = Extractor(robot, FACES, subscriber, self._on_faces)
        self._landmarks = Extractor(robot, LANDMARKS, subscriber, self._on_landmarks)
        self._movement = Extractor(robot, MOVEMENT, subscriber, self._on_movement, self._send_sensitivity)
        self._detections = {"face": self._faces, "motion": self._movement, "landmark": self._landmarks}
        node.if_it_fails(self.close)
        for name, detection in self._detections.items():
            folder = f"nao_vision/{name}_detection"
            node.offer(f"{folder}/enable", Empty, lambda _, detection=detection: detection.enable())
            node.offer(f"{folder}/disable", Empty, lambda _, detection=detection: detection.disable())
        folder = "nao_vision/face_detection"
        node.offer(f"{folder}/learn_face", LearnFace, partial(self._ask_person, "learnFace", limit=LEARN_LIMIT))
        node.offer(f"{folder}/forget_person", LearnFace, partial(self._ask_person, "forgetPerson"))
        node.offer("nao_vision/movement_detection_sensitivity", VisionMotionSensitivity, self._set_sensitivity)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {f"{name} detection": detection.report for name, detection in self._detections.items()}

    def close(self) -> None:
        for detection in self._detections.values():
            detection.close()

    def _topic(self, name: str, kind: type) -> rospy.Publisher:
        return self._node.publisher(f"nao_vision/{name}", kind, queue_size=QUEUE)

    # --- services -------------------------------------------------------------------------------------------------

    def _ask_person(self, method: str, request: Any, limit: float = 5.0) -> LearnFaceResponse:
        name = request.name.data.strip()
        if not name:
            raise NaoError("name: the name of a person, and it is empty")
        response = LearnFaceResponse()
        response.result.data = bool(self._faces.call(method, name, limit=limit))
        return response

    def _set_sensitivity(self, request: Any) -> None:
        value = request.sensitivity.data
        if not (math.isfinite(value) and 0.0 <= value <= 1.0):
            raise NaoError(f"sensitivity is {value:g}: 0 to 1")
        before, self._sensitivity = self._sensitivity, value
        try:
            self._send_sensitivity()
        except NaoError:
            self._sensitivity = before
            raise

    def _send_sensitivity(self) -> None:
        """Set the chosen sensitivity, if any; raises NaoError."""
        if self._sensitivity is None:
            return
        try:
            self._movement.call("setColorSensitivity", self._sensitivity)
        except (UnknownMethod, BadArguments):  # an older robot, with the older name
            self._movement.call("setSensitivity", self._sensitivity)

    # --- events, in threads of libqi ------------------------------------------------------------------------------

    def _on_faces(self, value: Any) -> None:
        found = read_faces(value)
        if found is not None:
            view, faces = found
            header = self._header(FACES, view)
            for face in faces:
                publish(self._faces_topic, to_face(face, view, header))

    def _on_landmarks(self, value: Any) -> None:
        seen = read_landmarks(value)
        if seen is not None:
            publish(self._landmarks_topic, to_landmarks(seen, self._header(LANDMARKS, seen)))

    def _on_movement(self, value: Any) -> None:
        with self._lock:
            movement = self._movements.read(value)
        if movement is not None:
            publish(self._movement_topic, to_movement(movement, self._header(MOVEMENT, movement.view)))

    def _header(self, kind: ExtractorKind, view: DetectionArray | None) -> Header:
        """Header of a detection; without a view, of now and the top camera."""
        frame = f"{self._prefix}{CAMERA_NAMES[TOP if view is None else view.camera]}_optical_frame"
        if view is None:
            return Header(stamp=rospy.Time.now(), frame_id=frame)
        # The simulated robot's clock is the one on /clock; that of a real robot may be any.
        time = view.time
        if is_wallclock():
            with self._lock:
                time = self._clocks[kind].take(view.time, rospy.get_time())
        return header_of(time, frame)
