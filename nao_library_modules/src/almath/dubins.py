"""Paths of two arcs and a straight piece between them (Dubins curves)."""

from __future__ import annotations

import math
from typing import NamedTuple

from almath._components import as_number, require
from almath.errors import AlmathError
from almath.pose2d import Pose2D
from almath.positions import Position2D
from almath.vectors import vectorPose2D

_LEFT, _RIGHT = 1.0, -1.0
_TURNS = ((_LEFT, _LEFT), (_LEFT, _RIGHT), (_RIGHT, _LEFT), (_RIGHT, _RIGHT))


class _Path(NamedTuple):
    """An arc, a straight piece and an arc; the turns are 1 to the left and -1 to the right."""

    length: float
    start: Position2D
    end: Position2D
    heading: float
    first_turn: float
    second_turn: float


def getDubinsSolutions(target: Pose2D, radius: float) -> vectorPose2D:
    """Path from the origin, heading along X, to a pose, in arcs of one radius.

    Of the paths that turn left or right at either end, the one with the shortest straight piece is taken. Raises
    AlmathError if the radius is not above zero or the target is too near.

    Args:
        target: Where to arrive, at least four radii away.
        radius: Of the arcs, in m.

    Returns:
        The pose at the start and at the end of the straight piece, and the target. The headings are not
        wrapped: the first has the sign of the first turn, and the last minus the second has the sign of the
        second turn.
    """
    require(target, Pose2D, "getDubinsSolutions")
    if not as_number(radius, "getDubinsSolutions radius") > 0.0:
        raise AlmathError(f"getDubinsSolutions takes a radius above zero, got {radius}")
    if not target.norm() >= 4.0 * radius:
        raise AlmathError(
            f"getDubinsSolutions takes a target four radii ({4.0 * radius} m) away or more, got {target!r}"
        )
    path = min((_path(target, radius, *turns) for turns in _TURNS), key=lambda candidate: candidate.length)
    start_heading = path.first_turn * (path.first_turn * path.heading % (2.0 * math.pi))
    last_turn = path.second_turn * (target.theta - path.heading) % (2.0 * math.pi)
    return vectorPose2D(
        [
            Pose2D(path.start.x, path.start.y, start_heading),
            Pose2D(path.end.x, path.end.y, target.theta - path.second_turn * last_turn),
            target,
        ]
    )


def _path(target: Pose2D, radius: float, first_turn: float, second_turn: float) -> _Path:
    first_centre = Position2D(0.0, first_turn * radius)
    second_centre = target * Position2D(0.0, second_turn * radius)
    between = second_centre - first_centre
    # Both ends of the straight piece lie beside their centre; seen from it, the second centre is this far to
    # the left of the first.
    offset = (second_turn - first_turn) * radius
    distance = between.norm()
    heading = between.getAngle() - math.asin(max(-1.0, min(1.0, offset / distance)))
    left = Position2D(-math.sin(heading), math.cos(heading)) * radius
    return _Path(
        length=math.sqrt(max(0.0, distance**2 - offset**2)),
        start=first_centre - left * first_turn,
        end=second_centre - left * second_turn,
        heading=heading,
        first_turn=first_turn,
        second_turn=second_turn,
    )
