"""The touch sensor that somebody means who points at the robot, by a line of sight."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from nao_sim_bridge.base.rotations import Vector3, from_roll_pitch_yaw, rotate
from nao_sim_bridge.model.robot_model import RobotModel

if TYPE_CHECKING:
    from nao_sim_bridge.body.physics import Physics

REACH = 0.025
"""A sensor is meant that is at most this far from the line of sight, m."""
HIDDEN = 0.03
"""One that is this much further away than what is seen, m, is behind it."""
FACING = 0.2
"""Cosine to the line of sight from which on a sensor is on the far side."""


def pointed_at(model: RobotModel, physics: Physics, eye: Vector3, direction: Vector3) -> frozenset[str]:
    """The sensor that is seen nearest to a line of sight; none when nothing is near.

    Args:
        eye: Where the line begins, m, in world.
        direction: Unit vector, in world.
    """
    seen_at = physics.free_sight(eye, direction)
    best, name = REACH, ""
    for place in model.touch:
        link = physics.pose_of(model.link(place.parent_link).alt_name)
        offset = rotate(link.orientation, [float(value) for value in place.position])
        way = [a + b - c for a, b, c in zip(link.position, offset, eye)]
        along = _dot(way, direction)
        aside = math.sqrt(max(_dot(way, way) - along * along, 0.0))
        if along <= 0.0 or along > seen_at + HIDDEN or aside >= best:
            continue
        outward = rotate(from_roll_pitch_yaw(*(float(angle) for angle in place.rpy)), (1.0, 0.0, 0.0))
        if _dot(rotate(link.orientation, outward), direction) < FACING:
            best, name = aside, place.name
    return frozenset((name,)) if name else frozenset()


def _dot(a: Vector3, b: Vector3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
