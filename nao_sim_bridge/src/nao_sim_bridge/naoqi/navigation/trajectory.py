"""Trajectories as ALNavigation.moveAlong takes them. Pure functions.

A trajectory is ["Holonomic", path, final theta, final time] or ["Composed", trajectory, ...]; each begins where the one
before has ended, in the frame of the robot there. A path is ["Line", [x, y]], ["Circle", [x, y], angle] with the centre
and how far around it the robot goes, or ["Composed", path, ...]; each begins where the one before has ended, and all
have the axes of the first. Lengths in m, angles in rad, times in s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, List, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.naoqi.binding.arguments import number, vector
from nao_sim_bridge.walk.footsteps import FootPose

FIELD = "trajectory"
HOLONOMIC, COMPOSED, LINE, CIRCLE = "Holonomic", "Composed", "Line", "Circle"
ARC = math.radians(15.0)
"""Of a circle between two places that the robot goes through."""
FARTHEST, LARGEST_TURN, LONGEST = 100.0, 20.0 * math.pi, 3600.0
Place = Tuple[float, float]


@dataclass(frozen=True)
class Stretch:
    """A way through poses, as seen from where it begins, in `time` s or more."""

    poses: Tuple[FootPose, ...]
    time: float


def read_trajectory(value: Any) -> List[Stretch]:
    """The stretches of a trajectory.

    Raises:
        BadValue: It is none; the text says which part of it, and what would be one.
    """
    stretches = _trajectory(value, FIELD)
    require_few(FIELD, sum(len(stretch.poses) for stretch in stretches), "places")
    return stretches


def _trajectory(value: Any, where: str) -> List[Stretch]:
    kind, parts = _named(value, where, '["Holonomic", path, theta, time] or ["Composed", trajectory, ...]')
    if kind == COMPOSED and parts:
        return [stretch for i, part in enumerate(parts) for stretch in _trajectory(part, f"{where}[{i + 1}]")]
    if kind != HOLONOMIC or len(parts) != 3:
        raise BadValue(where, value, '["Holonomic", path, theta, time] or ["Composed", trajectory, ...]')
    places = _path(parts[0], f"{where}[1]", (0.0, 0.0))
    theta = number(parts[1], f"{where}[2]", -LARGEST_TURN, LARGEST_TURN)
    time = number(parts[2], f"{where}[3]", 0.0, LONGEST)
    return [Stretch(tuple(_turned(places, theta)), time)]


def _path(value: Any, where: str, start: Place) -> List[Place]:
    """Places of a path, without the first."""
    allowed = '["Line", [x, y]], ["Circle", [x, y], angle] or ["Composed", path, ...]'
    kind, parts = _named(value, where, allowed)
    if kind == COMPOSED and parts:
        places: List[Place] = []
        for i, part in enumerate(parts):
            places += _path(part, f"{where}[{i + 1}]", places[-1] if places else start)
        return places
    if kind == LINE and len(parts) == 1:
        x, y = vector(parts[0], f"{where}[1]", 2, "[x, y] in m", -FARTHEST, FARTHEST)
        return [(start[0] + x, start[1] + y)]
    if kind == CIRCLE and len(parts) == 2:
        x, y = vector(parts[0], f"{where}[1]", 2, "[x, y] in m", -FARTHEST, FARTHEST)
        return _around(
            (start[0] + x, start[1] + y), start, number(parts[1], f"{where}[2]", -LARGEST_TURN, LARGEST_TURN)
        )
    raise BadValue(where, value, allowed)


def _named(value: Any, where: str, allowed: str) -> Tuple[str, Sequence[Any]]:
    if not isinstance(value, (list, tuple)) or not value or not isinstance(value[0], str):
        raise BadValue(where, value, allowed)
    return value[0], value[1:]


def _around(centre: Place, start: Place, angle: float) -> List[Place]:
    radius = math.dist(centre, start)
    begin = math.atan2(start[1] - centre[1], start[0] - centre[0])
    count = max(math.ceil(abs(angle) / ARC - 1e-9), 1)
    turns = (begin + angle * (i + 1) / count for i in range(count))
    return [(centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn)) for turn in turns]


def _turned(places: Sequence[Place], theta: float) -> List[FootPose]:
    """The places with headings that change evenly along the way, from 0 to `theta`."""
    lengths = [math.dist(a, b) for a, b in zip([(0.0, 0.0), *places], places)]
    whole, gone = sum(lengths), 0.0
    poses = []
    for (x, y), length in zip(places, lengths):
        gone += length
        poses.append(FootPose(x, y, theta * (gone / whole if whole > 0.0 else 1.0)))
    return poses
