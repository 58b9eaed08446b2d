"""Settings of nao_path_follower, paths on the floor, and where a robot on its way aims. No ROS; m and rad."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

from naoqi.errors import NaoError

from ...core.errors import BadGoal
from ...core.fields import limit, number_parameter
from ...core.geometry import Place, wrapped
from ..walk.walk_commands import require_way


@dataclass(frozen=True)
class FollowerSettings:
    """How a robot follows targets and paths; the names are those of the parameters.

    Raises NaoError with the first value that will not do.
    """

    controller_frequency: float = 10.0  # rounds a second, Hz
    target_distance_threshold: float = 0.05  # the target is reached this near, m
    target_angle_threshold: float = math.radians(5.0)  # and this well turned, rad
    waypoint_distance_threshold: float = 0.1  # off a path by more, the robot is not on a straight piece, m
    waypoint_angle_threshold: float = math.radians(45.0)  # turned away from a path by more, it first turns, rad
    # Velocity mode: shares of the robot's top speed, above 0 to 1.
    max_vel_x: float = 0.7
    max_vel_y: float = 0.7
    max_vel_yaw: float = 0.7
    # Velocity mode: step frequency that nao_walker walks with (its ~step_frequency), 0 (slow) to 1. By it the robot
    # gets so far in a round, and so has to be so slow to meet its target.
    step_freq: float = 0.5
    use_vel_ctrl: bool = False  # the robot is led by velocities (`cmd_vel`) and not by poses (`cmd_pose`)
    use_foot_contact_protection: bool = True  # a robot that is lifted gives its goal up
    path_next_target_distance: float = 0.1  # how far ahead on a path the robot aims, m
    path_max_start_distance: float = 0.3  # how far from the beginning of a path it may stand, m
    threshold_damp_xy: float = 0.2  # velocity mode: this near to the target it gets slower, m
    threshold_damp_yaw: float = math.radians(60.0)  # likewise for turning, rad
    straight_threshold: float = 0.2  # a piece of a path that is straight for this long is walked at full speed, m
    straight_offset: float = 0.3  # there the robot aims this far ahead, m
    straight_max_path_dev: float = 0.03  # and straight means this near to a line, m
    straight_max_robot_dev: float = 0.05  # with the robot this near to it, m
    straight_max_robot_yaw: float = math.radians(20.0)  # and turned away from it by no more than this, rad
    stuck_time: float = 10.0  # without any progress for so long the robot gives up, s; 0: never

    def __post_init__(self) -> None:
        for name in (field.name for field in fields(self)):
            _check(name, getattr(self, name))

    @classmethod
    def read(cls, get_param: Callable[[str, Any], Any]) -> FollowerSettings:
        """Settings from private parameters; `get_param` takes name and default."""
        return cls(**{field.name: get_param(f"~{field.name}", field.default) for field in fields(cls)})


_KINDS = {
    **dict.fromkeys(("max_vel_x", "max_vel_y", "max_vel_yaw"), "fraction"),
    "step_freq": "share",
    "stuck_time": "timeout",
    "controller_frequency": "reading rate",
}
_SWITCHES = ("use_vel_ctrl", "use_foot_contact_protection")


def _check(name: str, value: Any) -> None:
    if name in _SWITCHES:
        if not isinstance(value, bool):
            raise NaoError(f"~{name} is {value!r}: true or false")
        return
    kind = _KINDS.get(name, "setting")
    number_parameter(f"~{name}", value, limit(kind))
    if kind == "setting" and value <= 0.0:
        raise NaoError(f"~{name} is {value:g}: above 0")


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
        merged: list[Place] = []
        indices: list[int] = []
        for index, waypoint in enumerate(waypoints):
            if merged and waypoint.distance_to(merged[-1]) < SHORTEST:
                merged[-1] = waypoint  # of the last two, the later heading counts
                indices[-1] = index
            else:
                merged.append(waypoint)
                indices.append(index)
        if len(merged) < 2:
            count = f"{len(waypoints)} pose" + ("s at one place" if len(waypoints) > 1 else "")
            raise BadGoal("path.poses", count, "two at least; the action walk_target goes to a single pose")
        self.waypoints = tuple(merged)
        self._indices = tuple(indices)
        self._along = [0.0]
        for start, end in zip(merged, merged[1:]):
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


WINDOW = 0.5
"""m of a path beyond the robot's last place in which it is looked for: it does not jump where a path crosses itself."""
TURN_RADIUS = 0.05
"""m that a turn of 1 rad counts as where distances and turns are added up: little, for turns come and go."""


@dataclass(frozen=True)
class Aim:
    """Where to go next."""

    place: Place  # in the frame of the course
    final: bool  # the course ends there
    rest: float  # m that are left of the course; a turn counts by a radius. Progress makes it less
    index: int = 0  # of the waypoint ahead


class TargetCourse:
    """Straight to a target, which may drift as the robot learns better where it is.

    `target` gives its place now, in the frame of the course.
    """

    def __init__(self, target: Callable[[], Place]) -> None:
        self._target = target

    def aim(self, robot: Place) -> Aim:
        target = self._target()
        way = require_way("target_pose", target.seen_from(robot))
        return Aim(target, final=True, rest=way.distance + TURN_RADIUS * abs(way.yaw))


class PathCourse:
    """Along a path, aiming at a place of it that moves ahead of the robot."""

    def __init__(self, path: WalkPath, settings: FollowerSettings) -> None:
        self._path = path
        self._settings = settings
        self._along: float | None = None
        self._final = False  # a robot that has once aimed at the end does so from then on

    def aim(self, robot: Place) -> Aim:
        """Where a robot at this place goes next. Progress along the path is kept.

        Raises BadGoal if the robot is too far from where the path begins, at the first call.
        """
        along, off = self._find(robot)
        path, settings = self._path, self._settings
        away = wrapped(path.direction_at(along) - robot.yaw)
        near_end = path.length - along <= settings.path_next_target_distance
        if abs(away) > settings.waypoint_angle_threshold and not (near_end or self._final):
            here = path.place_at(along)
            place = Place(here.x, here.y, path.direction_at(along))
        else:
            ahead = along + self._look_ahead(along, off, away)
            self._final = self._final or ahead >= path.length
            place = path.place_at(path.length if self._final else ahead)
        rest = path.length - along + off + TURN_RADIUS * abs(wrapped(path.waypoints[-1].yaw - robot.yaw))
        at_end = path.length - along <= settings.target_distance_threshold
        return Aim(place, self._final, rest, path.index_at(path.length if at_end else along))

    def _find(self, robot: Place) -> tuple[float, float]:
        """How far along the path the robot is, and how far off it, m."""
        if self._along is None:
            begin = self._path.waypoints[0].distance_to(robot)
            if begin > self._settings.path_max_start_distance:
                limit = f"at most {self._settings.path_max_start_distance:g} m (~path_max_start_distance)"
                raise BadGoal("path", "", limit, f"the robot is too far from start of path, {begin:.2f} m")
            self._along = 0.0
        found = self._path.nearest(robot, self._along, self._along + WINDOW)
        self._along = found.along
        return found.along, found.off

    def _look_ahead(self, along: float, off: float, away: float) -> float:
        settings = self._settings
        on_it = off <= min(settings.straight_max_robot_dev, settings.waypoint_distance_threshold)
        turned = abs(away) <= settings.straight_max_robot_yaw
        stretch = along + max(settings.straight_threshold, settings.straight_offset)
        if on_it and turned and self._path.straight(along, stretch, settings.straight_max_path_dev):
            return max(settings.straight_offset, settings.path_next_target_distance)
        return settings.path_next_target_distance


def reached(way: Place, settings: FollowerSettings) -> bool:
    return way.distance <= settings.target_distance_threshold and abs(way.yaw) <= settings.target_angle_threshold
