"""The node nao_vision: faces, landmarks and movement, as the robot's own modules find them."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

import rospy
from rospy.rostime import is_wallclock
from std_msgs.msg import Header
from std_srvs.srv import Empty

from nao_library_msgs.msg import FaceDetected, LandmarkDetected, MovementDetected
from nao_library_msgs.srv import LearnFace, LearnFaceResponse, VisionMotionSensitivity
from naoqi.errors import BadArguments, NaoError, UnknownMethod
from naoqi.limits import LEARN_LIMIT

from ...nao.camera_facts import CAMERA_NAMES, TOP
from ...robot.image_clock import ImageClock
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ...ros.robot_frames import tf_prefix
from ...vision.detection.events import DetectionArray
from ..base.extractor import Extractor, ExtractorKind
from ..base.node import name_for_robot, publish
from ..camera.image_messages import header_of
from .vision_messages import to_face, to_landmarks, to_movement
from .vision_values import MovementReader, read_faces, read_landmarks

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
    the error of the service that was called: the others go on.

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
