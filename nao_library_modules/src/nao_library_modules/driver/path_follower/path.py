"""A path on the floor: lengths along it, places on it, how straight it is. Arithmetic only; m and rad."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from ...base.errors import BadGoal
from ...base.places import Place

SHORTEST = 1e-3
"""m: waypoints nearer to each other than this are one."""


@dataclass(frozen=True)
class OnPath:
    """The place of a path that is nearest to a robot: m from the beginning of the path, and from the robot."""

    along: float
    off: float


class WalkPath:
    """Straight lines from waypoint to waypoint. The last waypoint has a heading, elsewhere the path's direction counts.

    Of waypoints at one place only the last is kept.

    Raises BadGoal if there are not two different ones.
    """

    def __init__(self, waypoints: Sequence[Place]) -> None:
        kept: list[Place] = []
        indices: list[int] = []
        for index, waypoint in enumerate(waypoints):
            if kept and waypoint.distance_to(kept[-1]) < SHORTEST:
                kept[-1] = waypoint  # of the last two, the later heading counts
                indices[-1] = index
            else:
                kept.append(waypoint)
                indices.append(index)
        if len(kept) < 2:
            count = f"{len(waypoints)} pose" + ("s at one place" if len(waypoints) > 1 else "")
            raise BadGoal("path.poses", count, "two at least; the action walk_target goes to a single pose")
        self.waypoints = tuple(kept)
        self._indices = tuple(indices)
        self._along = [0.0]
        for start, end in zip(kept, kept[1:]):
            self._along.append(self._along[-1] + start.distance_to(end))
        self.length = self._along[-1]

    def place_at(self, along: float) -> Place:
        """The place `along` m from the beginning, heading along the path; at its end, as the last waypoint does."""
        if along >= self.length:
            return self.waypoints[-1]
        segment = self._segment(along)
        start, end = self.waypoints[segment], self.waypoints[segment + 1]
        share = max(0.0, along - self._along[segment]) / (self._along[segment + 1] - self._along[segment])
        x, y = start.x + share * (end.x - start.x), start.y + share * (end.y - start.y)
        return _towards(start, end)._replace(x=x, y=y)

    def direction_at(self, along: float) -> float:
        """Direction of the path, rad; that of its last piece at the end."""
        return self.place_at(min(along, self._along[-2])).yaw if along >= self.length else self.place_at(along).yaw

    def index_at(self, along: float) -> int:
        """Index of the waypoint, as it was given, that a robot at `along` is heading for."""
        return self._indices[min(bisect_right(self._along, along), len(self._along) - 1)]

    def nearest(self, robot: Place, begin: float, end: float) -> OnPath:
        """The place between `begin` and `end` (m along the path) that is nearest to a robot.

        Of places equally near, the first one counts.
        """
        begin, end = max(0.0, begin), min(self.length, end)
        best = OnPath(begin, self.place_at(begin).distance_to(robot))
        for segment in range(self._segment(begin), self._segment(end) + 1):
            along = min(max(self._projected(segment, robot), begin), end)
            off = self.place_at(along).distance_to(robot)
            if off < best.off - 1e-9:
                best = OnPath(along, off)
        return best

    def straight(self, begin: float, end: float, deviation: float) -> bool:
        """Whether the path stays within `deviation` m of the line between two of its places."""
        end = min(end, self.length)
        start, stop = self.place_at(begin), self.place_at(end)
        line = _towards(start, stop)
        chord = stop.seen_from(line).x
        first, last = bisect_right(self._along, begin), bisect_left(self._along, end)
        between = [waypoint.seen_from(line) for waypoint in self.waypoints[first:last]]
        return all(abs(p.y) <= deviation and -deviation <= p.x <= chord + deviation for p in between)

    def _segment(self, along: float) -> int:
        return min(max(bisect_right(self._along, along) - 1, 0), len(self.waypoints) - 2)

    def _projected(self, segment: int, robot: Place) -> float:
        start, end = self.waypoints[segment], self.waypoints[segment + 1]
        walked = robot.seen_from(_towards(start, end)).x
        return min(max(self._along[segment] + walked, self._along[segment]), self._along[segment + 1])


def _towards(start: Place, end: Place) -> Place:
    """The place `start`, heading for `end`."""
    return start._replace(yaw=math.atan2(end.y - start.y, end.x - start.x))
