"""Cameras: names of cameras, resolutions and parameters in goals, and what a chain has seen and taken."""

from __future__ import annotations

import re
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from nao_library_msgs.msg import PictureFile, RecordedVideo, SeenObject, VisionThread

from ..core import nao_facts
from ..core.chain import Part
from ..core.errors import BadGoal, did_you_mean
from ..core.nao_facts import CAMERA_NAMES, RESOLUTIONS
from ..core.processes import LaunchPath, launched_nodes

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic


VIDEO = "ALVideoDevice"
"""NAOqi's module for the cameras."""
CAMERAS = {name: number for number, name in nao_facts.CAMERAS.items()}
"""Name -> NAOqi's number."""
OPTICAL_FRAMES = {name: f"{CAMERA_NAMES[number]}_optical_frame" for name, number in CAMERAS.items()}
ONE_CAMERA = "top or 0, bottom or 1"
ANY_CAMERA = f"{ONE_CAMERA}, empty: the active one"
KNOWN_RESOLUTIONS = "one of " + ", ".join(
    f"{name} (or {number}, {w}x{h})" for name, (number, w, h) in RESOLUTIONS.items()
)
FRAME_RATES = (1, 30)
"""Frames a second, the least and the most."""

PARAMETERS = {
    "Brightness": 0,
    "Contrast": 1,
    "Saturation": 2,
    "Hue": 3,
    "RedChroma": 4,
    "BlueChroma": 5,
    "Gain": 6,
    "HFlip": 7,
    "VFlip": 8,
    "AutoExposition": 11,
    "AutoWhiteBalance": 12,
    "AutoGain": 13,
    "Exposure": 17,
    "ExposureCorrection": 21,
    "ExposureAlgorithm": 22,
    "Sharpness": 24,
    "WhiteBalance": 33,
    "BacklightCompensation": 34,
    "KeepAlive": 35,
    "Temperature": 38,
    "AverageLuminance": 39,
    "AutoFocus": 40,
    "Focus": 43,
}
"""Parameter of a camera, NAOqi's name without kCamera and ID -> NAOqi's number. Not every camera has all of them, and
the robot takes other numbers as well."""
KNOWN_PARAMETERS = f"one of {', '.join(PARAMETERS)}, also by NAOqi's name or number"
MOST_PARAMETERS = 64
_SPELLINGS = {name.lower(): number for name, number in PARAMETERS.items()}
_SPELLINGS.update(exposition=17, autoexposure=11)
_OTHERWISE = {"14": "setResolution", "15": "setFrameRate", "18": "setActiveCamera", "19": "setAllParametersToDefault"}
_OTHERWISE.update(resolution="setResolution", framerate="setFrameRate", select="setActiveCamera")
_OTHERWISE.update(setdefaultparams="setAllParametersToDefault")


def camera_name(text: str, active: str) -> str:
    """Name of a camera from its name or NAOqi's number in a goal; the active one for an empty text.

    Raises BadGoal if there is no such camera.
    """
    bare = text.strip().lower()
    if not bare:
        return active
    for name, number in CAMERAS.items():
        if bare in (name, str(number)):
            return name
    problem = f"{text!r} is no camera{did_you_mean(bare, CAMERAS)}"
    raise BadGoal("camera", text, ANY_CAMERA, problem=problem)


def resolution_name(text: str) -> str:
    """Name of a resolution, without the k (VGA), from its name, NAOqi's number or 640x480.

    Raises BadGoal if there is no such resolution.
    """
    bare = re.sub(r"\s", "", text).lower()
    for name, (number, width, height) in RESOLUTIONS.items():
        if bare in (name.lower(), f"k{name.lower()}", f"{width}x{height}", str(number)):
            return name
    problem = f"{text!r} is no resolution{did_you_mean(bare, [*RESOLUTIONS])}"
    raise BadGoal("resolution", text, KNOWN_RESOLUTIONS, problem=problem)


def resolution_of(number: int) -> str:
    """Name of a resolution by NAOqi's number; the number itself where it has none."""
    return next((name for name, (own, *_) in RESOLUTIONS.items() if own == number), str(number))


def parameter_number(text: str) -> int:
    """NAOqi's number of a parameter from brightness, kCameraBrightnessID or 0.

    Raises BadGoal if there is no such parameter, or another function sets it.
    """
    bare = re.sub(r"^k?camera_?|_?id$", "", text.strip(), flags=re.IGNORECASE).replace("_", "").lower()
    if bare in _OTHERWISE:
        problem = f"{text!r} is no parameter of the picture"
        raise BadGoal("str_param", text, f"{_OTHERWISE[bare]} and its like are for that", problem=problem)
    if bare.isdigit() and int(bare) < MOST_PARAMETERS:
        return int(bare)
    if bare not in _SPELLINGS:
        problem = f"{text!r} is no parameter of a camera{did_you_mean(bare, PARAMETERS)}"
        raise BadGoal("str_param", text, KNOWN_PARAMETERS, problem=problem)
    return _SPELLINGS[bare]


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
