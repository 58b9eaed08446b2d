"""Walks to a place beside something that may move. Simulation thread only."""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass
from typing import Any, Callable, Sequence, Tuple

from nao_sim_bridge.base.errors import MoveRefused
from nao_sim_bridge.tracking.geometry import Point, turn_to
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait

log = logging.getLogger("nao_sim.tracker")

# A walk is sent elsewhere when its goal has moved by more than this, m and rad, and not more often than this, s.
GOAL_MOVED, GOAL_TURNED, SOONEST = 0.06, 0.2, 0.7
# Who stands has to be further off than where it stops, by this factor, before it walks again: pictures are noisy.
LEAVE = 1.5


@dataclass(frozen=True)
class Relative:
    """Where the robot should be, m and rad, as seen from the thing, whose X axis points away from the robot.

    With a negative x it is this side of the thing. The tolerances, m, m, rad, say how near is there.
    """

    x: float = -0.3
    y: float = 0.0
    yaw: float = 0.0
    tolerances: Tuple[float, float, float] = (0.1, 0.1, 0.3)


class Approach:
    """Walks to where the robot should be, `relative` to the thing; calls `reached` each time that it has got there."""

    def __init__(self, simulation: Any) -> None:
        self.relative = Relative()
        self.gait = FeetGait()
        self.reached: list[Callable[[], None]] = []
        self._simulation = simulation
        self._goal: FootPose | None = None
        self._next = 0.0
        self._there = False
        self._refused = ""

    def go(self, here: Sequence[float], place: Point, time: float) -> None:
        """Walk on from `here`, x, y in m and heading in rad, to the place of the thing, m, both in world; time in s."""
        robot = FootPose(*here)
        goal = goal_beside(robot, place, self.relative)
        away = goal.seen_from(robot)
        locomotion = self._simulation.robot.locomotion
        factor = LEAVE if self._there else 1.0
        if all(abs(a) <= factor * limit for a, limit in zip(away, self.relative.tolerances)):
            if locomotion.active and self._goal is not None and not self._there:
                return  # it walks the last steps
            if not self._there:
                self._there = True
                for call in self.reached:
                    call()
            return
        self._there = False
        if time < self._next or (locomotion.active and self._goal is not None and not self._moved(goal)):
            return
        self._next = time + SOONEST
        self._walk(away, goal)

    def stop(self) -> None:
        """End a walk that was begun here."""
        if self._goal is not None and self._simulation.robot.walking:
            self._simulation.robot.locomotion.stop()
        self.forget()

    def forget(self) -> None:
        """There is nothing to go to."""
        self._goal, self._there, self._next = None, False, 0.0

    def _walk(self, away: FootPose, goal: FootPose) -> None:
        try:
            self._simulation.robot.locomotion.move_to([away], self.gait)
        except MoveRefused as error:
            if str(error) != self._refused:
                log.warning("cannot walk to what is tracked: %s", error)
            self._refused, self._goal = str(error), None
            return
        self._refused, self._goal = "", goal

    def _moved(self, goal: FootPose) -> bool:
        return (
            math.hypot(goal.x - self._goal.x, goal.y - self._goal.y) > GOAL_MOVED
            or abs(turn_to(self._goal.yaw, goal.yaw)) > GOAL_TURNED
        )


def goal_beside(robot: FootPose, place: Point, relative: Relative) -> FootPose:
    bearing = math.atan2(place[1] - robot.y, place[0] - robot.x)
    return FootPose(place[0], place[1], bearing).moved(relative.x, relative.y, relative.yaw)
