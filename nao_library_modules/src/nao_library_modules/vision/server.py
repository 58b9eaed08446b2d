"""The module for vision: streams, recordings, pictures, settings of the cameras, and what the robot recognises."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from nao_library_actions.msg import NaoVisionAction

from ..base.answers import Outcome
from ..base.errors import BadGoal
from ..processes.launcher import LaunchPath, launched_nodes
from ..server.extractor_use import subscriber_name
from ..server.nao_basic import NaoBasic
from .capture.files import DEFAULT_RECORD_DIR, VisionFiles
from .capture.jobs import CaptureJobs
from .capture.settings import SettingFunctions
from .capture.snapshots import PictureFunctions
from .capture.streaming import StreamingFunctions
from .capture.taken import Taken
from .detection.faces import FaceFunctions
from .detection.results import Seen
from .detection.things import TYPED, DetectionFunctions
from .detection.track import TrackingFunctions

CAMERAS = ("nao_library", "cameras.launch")
"""Launch file of the robot's cameras."""
IMAGES_LIMIT, IMAGES_LOOK = 15.0, 0.1
"""s of wall time that the cameras of another launch file may take to come, and between two looks for them."""
PARAMETERS = {
    "record_dir": DEFAULT_RECORD_DIR,
    "camera_top": "nao_robot/camera/top/image_raw",
    "camera_bottom": "nao_robot/camera/bottom/image_raw",
    "camera_top_node": "nao_camera/top",
    "camera_bottom_node": "nao_camera/bottom",
}
"""Private parameters of the node -> default."""


class NaoVision(
    NaoBasic,
    StreamingFunctions,
    PictureFunctions,
    SettingFunctions,
    FaceFunctions,
    TrackingFunctions,
    DetectionFunctions,
):
    """Vision goals: streams, recordings and pictures of any camera, and what NAOqi recognises in those of the robot.

    Streams and recordings are their user's: they have names that the user gave them, go on when the goal that began
    them is over or preempted, each in a thread of its own, and end when they are stopped, or complete with the server.
    Everything else ends with its function.

    Frames come from ROS topics, so any camera with a driver for ROS can stand in for the robot's. Files are on the
    computer that runs this server, in `record_dir`; not on the robot.

    Attributes:
        active_camera: The camera of functions that name none: top or bottom.
        seen: What the chain has recognised so far.
        taken: What the chain has taken so far.
        subscriber: What NAOqi knows this server by.
        frame_prefix: Prefix of the robot's frames, with its slash; may be empty.

    ROS API:
        Action `NaoVision` (nao_library_actions/NaoVisionAction) and what NaoBasic offers. Subscribes to the cameras
        (sensor_msgs/Image or CompressedImage), only while frames are wanted. Publishes the streams. Calls
        `set_parameters` (dynamic_reconfigure) of the cameras' nodes.
    """

    typed_answers = TYPED | {"takePicture", "takePictures", "stopRecording", "listThreads"}

    without_robot = frozenset({**StreamingFunctions.functions, **PictureFunctions.functions})
    """They take topics, of any camera."""
    left_by_goals = frozenset({"threads", "files", "topics"})

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = CAMERAS,
        record_dir: str = PARAMETERS["record_dir"],
        camera_top: str = PARAMETERS["camera_top"],
        camera_bottom: str = PARAMETERS["camera_bottom"],
        camera_top_node: str = PARAMETERS["camera_top_node"],
        camera_bottom_node: str = PARAMETERS["camera_bottom_node"],
        topics: Any = None,
        **options: Any,
    ) -> None:
        """Start the server.

        Args:
            ip: Address of the robot.
            port: Port of its NAOqi.
            autostart: As NaoBasic takes it.
            launchpath: As NaoBasic takes it, None stands for the robot's cameras. The images of any other
                launch file are the camera top, and those of a second topic the camera bottom.
            record_dir: Folder for pictures and videos; "~" stands for the home of the user.
            camera_top: Topic of the pictures of the camera that goals call top.
            camera_bottom: Topic of those of the one that they call bottom.
            camera_top_node: Where the node of the first takes dynamic_reconfigure.
            camera_bottom_node: Where that of the second does.
            topics: Topics and settings of cameras, where not those of this process's node.
            options: As NaoBasic takes them.
        """
        if topics is None:
            from .capture.topics import VisionTopics

            topics = VisionTopics()
        super().__init__(ip, port, autostart, launchpath or CAMERAS, **options)
        self.topics = topics
        self.files = VisionFiles(record_dir)
        self.threads = CaptureJobs()
        self.camera_topics = {"top": camera_top, "bottom": camera_bottom}
        self.camera_servers = {"top": camera_top_node, "bottom": camera_bottom_node}
        self.active_camera = "top"
        self.seen = Seen()
        self.taken = Taken()
        self.subscriber = subscriber_name("NaoVision", str(self._node.namespace))
        self.frame_prefix = self._node.frame_prefix()
        self._took_over = False
        self._brought: Any = None  # the launch file that nodes and images here are of
        self._nodes: frozenset[str] = frozenset()
        self._images: list[str] = []
        self.make_again()
        self.serve("NaoVision", NaoVisionAction)

    def camera_topic(self, camera: str) -> str:
        """Topic of a camera's pictures.

        A launch file of one's own brings its cameras: the topic of the robot's own if that is among its images, else
        those named image_raw first, then by name.

        Raises:
            BadGoal: If the nodes of the launch file publish no image for it.
        """
        topic = self.camera_topics[camera]
        if tuple(self.launchpath) == CAMERAS or topic != PARAMETERS[f"camera_{camera}"]:
            return topic
        if self._brought != self.launchpath:
            self._nodes = launched_nodes(self.launchpath, self.ip, self.port, str(self._node.namespace))
            self._brought, self._images = self.launchpath, []
        place, give_up = list(self.camera_topics).index(camera), time.monotonic() + IMAGES_LIMIT
        while True:
            published = self.topics.images_of(self._nodes)
            if self.topics.resolved(topic) in published:
                return topic
            # One that comes later stands behind those that were there: a camera goes on being the one that it was.
            self._images += [image for image in published if image not in self._images]
            if len(self._images) > place:
                return self._images[place]
            if published or time.monotonic() > give_up:
                break
            self.interrupt.wait(IMAGES_LOOK)
            self.interrupt.check()
        shown = ", ".join(published) if published else "no image"
        found = f"{' '.join(self.launchpath)} brings no camera {camera!r}: its nodes publish {shown}"
        raise BadGoal("camera", camera, "a camera of the launch file, or a topic in `topic`", problem=found)

    # The life of a goal

    def begin_chain(self) -> None:
        """Forget what the last chain saw and took."""
        self.seen = Seen()
        self.taken = Taken()
        if not self._took_over and self.robot.connection.state == "connected":
            self._took_over = self.end_leftover_detections()

    def tell(self, status: str, objects: Sequence[Any] = (), done: int = 0, stamp: float | None = None) -> None:
        """Publish what is seen meanwhile. Called from the thread that executes goals.

        Args:
            status: What the robot is doing.
            objects: SeenObject messages.
            done: How many pictures were taken.
            stamp: ROS time of what is told, s; None for now.
        """
        self.publish_feedback(stamp=stamp, status=status, done=done, objects=list(objects))

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add what was seen and taken."""
        super().fill_result(result, outcomes)
        self.seen.fill(result)
        self.taken.fill(result)

    def shutdown_steps(self) -> list[Callable[[], Any]]:
        """As NaoBasic has them; streams and recordings end first, so that files are complete whatever else takes long.

        They end once more for a goal that was just about to start one.
        """
        return [self.interrupt.stop, self.threads.close, *super().shutdown_steps(), self.threads.close]
