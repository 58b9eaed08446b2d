"""State that the functions of NaoVision share: which cameras there are, and what a chain has seen and taken."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from nao_library_msgs.msg import PictureFile, RecordedVideo, SeenObject, VisionThread

from ...base.errors import BadGoal
from ...functions.parts import Part
from ...processes.launcher import LaunchPath, launched_nodes
from .cameras import camera_name

if TYPE_CHECKING:
    from ...server.nao_basic import NaoBasic

CAMERAS_LAUNCH = ("nao_library", "cameras.launch")
"""Launch file of the robot's cameras."""
IMAGES_LIMIT, IMAGES_PERIOD = 60.0, 0.1
"""s of wall time: how long to wait for the cameras of another launch file, and between two checks."""
CAMERA_TOPICS = {"top": "nao_robot/camera/top/image_raw", "bottom": "nao_robot/camera/bottom/image_raw"}
"""Camera -> default topic of its pictures."""


class ChainResults(Part):
    """What the functions of one chain have seen and taken, for the result message."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.objects: list[SeenObject] = []
        self.pictures: list[PictureFile] = []
        self.recordings: list[RecordedVideo] = []  # those that are complete
        self.threads: list[VisionThread] = []

    def fill(self, result: Any) -> None:
        result.objects, result.threads = self.objects, self.threads
        result.pictures, result.recordings = self.pictures, self.recordings


class Cameras(Part):
    """The cameras that goals name top and bottom, and the topics of their pictures."""

    left_by_goals = frozenset({"topics"})

    def __init__(self, module: NaoBasic, topics: Any, camera_topics: Mapping[str, str], namespace: str) -> None:
        """Begin with the top camera as the active one.

        Args:
            module: Its launch file brings the cameras.
            topics: VisionTopics, or what takes its place.
            camera_topics: Camera -> topic of its pictures.
            namespace: Of the node, and so of what the launch file brings.
        """
        self.active = "top"
        self.topics = topics
        self._module = module
        self._camera_topics = camera_topics
        self._namespace = namespace
        self._launchpath: LaunchPath | None = None  # the launch file that nodes and images are of
        self._nodes: frozenset[str] = frozenset()
        self._images: list[str] = []

    def name(self, camera: str) -> str:
        """Name of a camera as a goal has it; of the active one if that is empty."""
        return camera_name(camera, self.active)

    def source(self, camera: str, topic: str) -> str:
        """Full name of the topic that a goal names, or of that of the camera that it names."""
        return self.topics.resolved(topic.strip() or self.topic_of(self.name(camera)))

    def topic_of(self, camera: str) -> str:
        """Topic of a camera's pictures.

        A user's launch file brings its cameras: the topic of the robot's own if that is among its images, else those
        named image_raw first, then by name. Raises BadGoal if the nodes of the launch file publish no image for it.
        """
        topic, launchpath = self._camera_topics[camera], self._module.launchpath
        if tuple(launchpath) == CAMERAS_LAUNCH or topic != CAMERA_TOPICS[camera]:
            return topic
        if self._launchpath != launchpath:
            module = self._module
            self._nodes = launched_nodes(launchpath, module.ip, module.port, self._namespace)
            self._launchpath, self._images = launchpath, []
        place, give_up = list(self._camera_topics).index(camera), time.monotonic() + IMAGES_LIMIT
        while True:
            published = self.topics.images_of(self._nodes)
            if self.topics.resolved(topic) in published:
                return topic
            # A later image stands behind the earlier ones: a camera keeps its topic.
            self._images = [*self._images, *(image for image in published if image not in self._images)]
            if len(self._images) > place:
                return self._images[place]
            if published or time.monotonic() > give_up:
                break
            self._module.interrupt.wait(IMAGES_PERIOD)
            self._module.interrupt.check()
        shown = ", ".join(published) if published else "no image"
        found = f"{' '.join(launchpath)} brings no camera {camera!r}: its nodes publish {shown}"
        raise BadGoal("camera", camera, "a camera of the launch file, or a topic in `topic`", problem=found)
