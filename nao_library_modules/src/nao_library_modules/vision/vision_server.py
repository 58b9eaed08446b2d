"""Pictures, streams and recordings of cameras."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from nao_library_actions.msg import NaoVisionAction

from ..core.health import recordings_report
from ..core.memory_functions import Outcome
from ..core.processes import LaunchPath
from ..core.robot_events import subscriber_name
from ..nao_basic import NaoBasic
from .camera_functions import PictureFunctions, SettingFunctions
from .cameras import CAMERA_TOPICS, Cameras, ChainResults
from .cameras import CAMERAS_LAUNCH as CAMERAS
from .capture_jobs import CaptureJobs
from .detectors import DETECTORS, DetectionFunctions, Detectors, FaceFunctions
from .streaming import StreamingFunctions
from .tracking import TrackingFunctions
from .video import DEFAULT_RECORD_DIR, VisionFiles

PARAMETERS = {
    "record_dir": DEFAULT_RECORD_DIR,
    "camera_top": CAMERA_TOPICS["top"],
    "camera_bottom": CAMERA_TOPICS["bottom"],
    "camera_top_node": "nao_camera/top",
    "camera_bottom_node": "nao_camera/bottom",
}
"""Private parameters of the node -> default."""


class NaoVision(NaoBasic):
    """Vision goals: streams, recordings and pictures of any camera, and what NAOqi recognises in those of the robot.

    Streams and recordings have names that the user gave them and a thread each. They go on when the goal that began
    them is over or preempted, and end when they are stopped, or complete with the server. Everything else ends with its
    function.

    Frames come from ROS topics, so any camera with a driver for ROS can stand in for the robot's. Files are on the
    computer that runs this server, in `record_dir`; not on the robot.

    Attributes:
        cameras: The active camera, and the topics of both.
        files: Folder for pictures and videos.
        jobs: Streams and recordings.
        detectors: The robot's extractors.

    ROS API:
        Action `NaoVision` (nao_library_actions/NaoVisionAction) and what NaoBasic offers. Subscribes to the cameras
        (sensor_msgs/Image or CompressedImage), only while frames are wanted. Publishes the streams. Calls
        `set_parameters` (dynamic_reconfigure) of the cameras' nodes.
    """

    part_types = (
        StreamingFunctions,
        PictureFunctions,
        SettingFunctions,
        FaceFunctions,
        TrackingFunctions,
        DetectionFunctions,
    )
    typed_answers = frozenset({"takePicture", "takePictures", "stopRecording", "listThreads"})
    # They take topics, of any camera.
    without_robot = frozenset({**StreamingFunctions.functions, **PictureFunctions.functions})

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
        """Start the server; arguments as NaoBasic takes them, but for these.

        Args:
            launchpath: As NaoBasic takes it, None stands for the robot's cameras. The images of any other
                launch file are the camera top, and those of a second topic the camera bottom.
            record_dir: Folder for pictures and videos; "~" stands for the home of the user.
            camera_top: Topic of the pictures of the camera top.
            camera_bottom: Topic of the pictures of the camera bottom.
            camera_top_node: Where the node of the camera top takes dynamic_reconfigure.
            camera_bottom_node: Where the node of the camera bottom takes it.
            topics: Topics and settings of cameras, where not those of this process's node.
        """
        if topics is None:
            from .vision_topics import VisionTopics

            topics = VisionTopics()
        super().__init__(ip, port, autostart, launchpath or CAMERAS, **options)
        namespace = str(self._node.namespace)
        self.cameras = Cameras(self, topics, {"top": camera_top, "bottom": camera_bottom}, namespace)
        self.files = VisionFiles(record_dir)
        self.jobs = CaptureJobs()
        # First, so that files are complete whatever else takes long; and last, for a goal that was about to start one.
        self.at_end(self.interrupt.stop, self.jobs.close, first=True)
        self.at_end(self.jobs.close)
        self._results = ChainResults()
        self.detectors = Detectors(
            self, self.cameras, self._results, subscriber_name("NaoVision", namespace), self._node.frame_prefix()
        )
        self._took_over = False
        streaming = StreamingFunctions(self, self.cameras, self.files, self.jobs, self._results)
        detections = DetectionFunctions(self.detectors)
        self.add_parts(
            self.cameras,
            self.detectors,
            self._results,
            streaming,
            PictureFunctions(self, self.cameras, self.files, self._results),
            SettingFunctions(self, self.cameras, {"top": camera_top_node, "bottom": camera_bottom_node}),
            FaceFunctions(self.detectors, detections),
            TrackingFunctions(self.detectors),
            detections,
        )
        streaming.make_again()
        self.own_reports["recordings"] = lambda: recordings_report(self.jobs.recorded())
        self.serve("NaoVision", NaoVisionAction)

    def begin_chain(self) -> None:
        """Forget what the last chain has seen and taken."""
        self._results.clear()
        if not self._took_over and self.robot.connection.state == "connected":
            self._took_over = self.detectors.end_leftovers(each.module for each in DETECTORS.values())

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add what the chain has seen and taken."""
        super().fill_result(result, outcomes)
        self._results.fill(result)
