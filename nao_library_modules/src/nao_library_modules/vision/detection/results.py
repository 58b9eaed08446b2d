"""What a goal has seen so far, and the messages that carry it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from genpy import Time
from geometry_msgs.msg import Point
from std_msgs.msg import Header

from nao_library_msgs.msg import SeenObject

from ..capture.cameras import CAMERAS, OPTICAL_FRAMES
from .space import LocalizedDetection

BASE = "base_footprint"
"""Frame of the robot on the floor between its feet, as its description and nao_joint_states name it."""


class Seen:
    """What the functions of one chain saw, for its result.

    Attributes:
        objects: In the order in which the functions saw them.
    """

    def __init__(self) -> None:
        """Nothing yet."""
        self.objects: list[SeenObject] = []

    def fill(self, result: Any) -> None:
        """Put everything into a result message."""
        result.objects = self.objects


def seen_message(detection: LocalizedDetection, prefix: str) -> SeenObject:
    """A detection as a message.

    Args:
        detection: What was seen.
        prefix: That of the robot's frames, with its slash; may be empty.
    """
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
        base_frame=prefix + BASE,
        position=Point(*detection.in_robot),
        camera_origin=Point(*detection.camera_in_robot),
    )


def seen_messages(detections: Sequence[LocalizedDetection], prefix: str) -> list[SeenObject]:
    """Sightings as messages."""
    return [seen_message(detection, prefix) for detection in detections]
