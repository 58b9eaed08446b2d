"""A walk to a place in the world, through others."""

from __future__ import annotations

from math import copysign, sqrt
from typing import Mapping, NamedTuple, Sequence

from nao_sim_bridge.walk.courses import ROUNDING, STANDSTILL, Course, Rate, Step, rate_limits
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.settings import WalkSettings

# Closer than this to its goal, m and rad, the robot has arrived.
ARRIVED, ARRIVED_TURN = 0.005, 0.01


class _Nearing(NamedTuple):
    rate: Rate
    goal: int
    closed: bool


class TargetCourse(Course):
    """Goes to a place in the world, through others.

    Args:
        goals: Poses of the robot in the world, the last one is where it ends.
        steps: Take so many at least; fewer would be faster than asked for.
        rate: At which the robot walks already.
    """

    def __init__(
        self,
        settings: WalkSettings,
        gait: FeetGait,
        goals: Sequence[FootPose],
        steps: int = 1,
        rate: Rate = STANDSTILL,
    ) -> None:
        self._goals = tuple(goals)
        self._steps = steps
        self._first = 1
        super().__init__(settings, gait, rate)

    def begin_towards(self, robot: FootPose) -> None:
        """Choose the foot that moves first, from where the robot is in the world."""
        way = self._goals[0].seen_from(robot)
        self._first = -1 if (way.y or way.yaw) < 0.0 else 1

    def first_side(self, _: Mapping[int, FootPose]) -> int:
        return self._first

    def take(self, support: FootPose, side: int) -> None:
        super().take(support, side)
        self._steps -= 1
        self.reached = self.reached or self._state.closed

    def _first_state(self, rate: Rate) -> _Nearing:
        return _Nearing(rate, 0, False)

    def _next(self, state: _Nearing, support: FootPose, side: int) -> tuple[Step, _Nearing] | None:
        if state.closed:
            return None
        centre = support.moved(0.0, side * self._half)
        goal = state.goal
        way = self._way(goal, centre)
        while goal < len(self._goals) - 1 and self._steps_for(way, ahead=True) <= 1.0:
            goal += 1
            way = self._way(goal, centre)
        if goal == len(self._goals) - 1 and max(abs(way.x), abs(way.y)) < ARRIVED and abs(way.yaw) < ARRIVED_TURN:
            landing = centre.moved(*way).moved(0.0, side * self._half)
            return self._step(side, landing), _Nearing(STANDSTILL, goal, True)
        rate = self._change(state.rate, self._towards(way, goal))
        landing = self._landing_towards(support, side, rate, way)
        return self._step(side, landing), _Nearing(rate, goal, False)

    def _way(self, goal: int, centre: FootPose) -> FootPose:
        """From the robot to a goal, in the frame of the robot."""
        return self._goals[goal].seen_from(self.frame.moved(*centre))

    def _steps_for(self, way: FootPose, ahead: bool) -> float:
        """How many steps a way takes at full speed, braking to its end when nothing comes after it."""
        squares = 0.0
        for part, most, change in zip(way, rate_limits(self._gait, way.x >= 0.0), self._settings.change):
            fastest = most if ahead else min(most, braking(abs(part), change))
            squares += (abs(part) / max(fastest, ROUNDING)) ** 2
        return sqrt(squares)

    def _towards(self, way: FootPose, goal: int) -> Rate:
        last = goal == len(self._goals) - 1
        count = max(self._steps_for(way, ahead=not last), float(self._steps), 1.0)
        share = self.haste / count
        return (share * way.x, share * way.y, share * way.yaw)

    def _landing_towards(self, support: FootPose, side: int, rate: Rate, way: FootPose) -> FootPose:
        """As `_landing`, but not past the goal: of two steps, one goes further aside than the other."""
        centre = support.moved(0.0, side * self._half)
        beside = self._landing(support, side, rate).moved(0.0, -side * self._half)
        made = beside.seen_from(centre)
        x, y, yaw = (copysign(min(abs(m), abs(w)), m) if m * w > 0.0 else m for m, w in zip(made, way))
        return centre.moved(x, y, yaw).moved(0.0, side * self._half)


def braking(distance: float, change: float) -> float:
    """Way of a step from which the robot can still slow down, by `change` each step, to be at rest after `distance`."""
    return change * (sqrt(0.25 + 2.0 * distance / change) - 0.5) if distance > change else distance
