"""Where a robot aims that follows a target or a path. Pure logic: no ROS, no clock."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...base.errors import BadGoal
from ...base.places import Place, wrapped
from ..walk.walk_commands import require_way
from .path import WalkPath
from .settings import FollowerSettings

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
