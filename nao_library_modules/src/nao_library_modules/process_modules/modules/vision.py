"""Vision: looking for things, by the action of the server NaoVision."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from nao_library_actions.msg import NaoVisionAction, NaoVisionGoal
from nao_library_msgs.msg import VisionFunction

from ...base.places import ODOM
from ...base.suggestion import of_those
from ..language.failures import PerceptionLowLevelFailure, PerceptionObjectNotFound
from ..language.space import Point3
from .robot_module import RobotModule

VISION_ACTION = "NaoVision"
VISION_MARGIN = 10.0
"""s that the server may take beyond what it was given to look."""
NOT_CHOSEN = ("", "bottom")
"""Cameras to look with, one after the other, where none is named; empty: the active one."""
DETECTORS = {
    "ball": "detectBall",
    "face": "detectFaces",
    "person": "detectFaces",
    "landmark": "detectLandmarks",
    "code": "readBarcodes",
}
"""What is detected, by the type of an object."""


@dataclass(frozen=True)
class SeenThing:
    """Something that was seen."""

    type: str
    name: str  # of a face, a landmark's number, a code's text; empty if unknown
    position: Point3 | None  # in odom; None if only the direction is known
    time: float  # s of ROS time
    confidence: float
    alpha: float  # rad, positive to the left of the camera's axis
    beta: float  # rad, positive below it


class Vision(RobotModule):
    """Looks for things."""

    name = "vision"
    methods = ("detect",)

    def detect(
        self, type: str, name: str = "", timeout: float = 2.0, search: bool = False, camera: str = "", size: float = 0.0
    ) -> list[SeenThing]:
        """Look for things of a type in `DETECTORS` for `timeout` s; returns those seen.

        Raises PerceptionObjectNotFound: nothing was seen in time; PerceptionLowLevelFailure: looking failed.

        Args:
            name: Only that one: a face's name, a landmark's number, a code's text.
            search: Whether the head turns to find them.
            camera: top or bottom; empty: the active one (top at first), and then the bottom one, as long again: a robot
                that has walked looks straight ahead, and what lies before it is in the picture of that one alone.
            size: Of the real thing, m; 0 for what is usual.
        """
        if type not in DETECTORS:
            raise PerceptionLowLevelFailure(f"there is no detector for {type!r}{of_those(type, DETECTORS)}")
        kind = "face" if type == "person" else type
        function, wanted = ("lookFor", f"{kind} {name}".strip()) if search else (DETECTORS[type], name)
        cameras = (camera,) if camera or search else NOT_CHOSEN
        for each in cameras:
            look = VisionFunction(function=function, str_param=wanted, camera=each, size=size, timeout=timeout)
            end = self.robot.action(VISION_ACTION, NaoVisionAction).call(NaoVisionGoal([look]), timeout + VISION_MARGIN)
            if not end.succeeded:
                raise PerceptionLowLevelFailure(f"{function}: {end}")
            if end.result.objects:
                return [self._seen(thing) for thing in end.result.objects]
        looked = ", nor ".join(f"in {timeout:g} s by the {each or 'active'} camera" for each in cameras)
        hint = "" if search else "; with `search` the head turns"
        text = f"no {f'{type} {name}'.strip()} was seen {looked}{hint}"
        raise PerceptionObjectNotFound(text, type=type, name=name)

    def _seen(self, found: Any) -> SeenThing:
        """In odom: the robot's own frame moves."""
        where = found.position
        position = None
        if found.located:
            position = self.robot.point_in(Point3(where.x, where.y, where.z, found.base_frame), ODOM)
        time = found.header.stamp.to_sec()
        return SeenThing(found.kind, found.name, position, time, found.confidence, found.alpha, found.beta)
