"""What a goal has seen so far, and the messages that carry it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from genpy import Time
from geometry_msgs.msg import Point
from std_msgs.msg import Header

from nao_library_msgs.msg import SeenObject

from ..capture.cameras import CAMERAS, OPTICAL_FRAMES
from .space import Sighting

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


def seen_message(sighting: Sighting, prefix: str) -> SeenObject:
    """A sighting as a message.

    Args:
        sighting: What was seen.
        prefix: That of the robot's frames, with its slash; may be empty.
    """
    sight, region = sighting.sight, sighting.region
    camera = next(name for name, number in CAMERAS.items() if number == sighting.camera)
    return SeenObject(
        header=Header(stamp=Time.from_sec(sighting.time), frame_id=prefix + OPTICAL_FRAMES[camera]),
        kind=sight.kind,
        name=sight.name,
        confidence=sight.confidence,
        camera=camera,
        looks=sighting.looks,
        alpha=sight.alpha,
        beta=sight.beta,
        size_x=sight.size_x,
        size_y=sight.size_y,
        heading=sight.heading,
        x=region.x,
        y=region.y,
        width=region.width,
        height=region.height,
        located=sighting.distance is not None,
        distance=sighting.distance or 0.0,
        camera_position=Point(*sighting.in_optical),
        base_frame=prefix + BASE,
        position=Point(*sighting.in_robot),
        camera_origin=Point(*sighting.camera_in_robot),
    )


def seen_messages(sightings: Sequence[Sighting], prefix: str) -> list[SeenObject]:
    """Sightings as messages."""
    return [seen_message(sighting, prefix) for sighting in sightings]
