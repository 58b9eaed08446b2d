"""Velocities that lead a robot along a way, and the check that it gets nearer. Arithmetic only."""

from __future__ import annotations

import math

from naoqi.errors import NaoError

from ...base.places import Place, wrapped
from ...nao.walk_speed import top_speeds
from .settings import FollowerSettings

FACE_DISTANCE = 0.4
"""m: to what is further away the robot turns its face; it walks ahead faster than sideways."""
PROGRESS = 0.02
"""m that count as progress."""
LONGEST_ROUND = 1.0
"""s that a round counts at most: in a longer one the robot was silent, or this program stopped."""


def velocity(way: Place, settings: FollowerSettings) -> tuple[float, float, float]:
    """Shares -1..1 of the top speeds ahead, to the left and turning left, for a way in the robot's frame.

    None is so large that the robot would be past its target in the next round, at the step frequency of the settings.
    """
    far = way.distance > FACE_DISTANCE
    turn = math.atan2(way.y, way.x) if far else way.yaw
    top, top_turn = (speed / settings.controller_frequency for speed in top_speeds(settings.step_freq))
    yaw = settings.max_vel_yaw * max(-1.0, min(1.0, wrapped(turn) / settings.threshold_damp_yaw))
    yaw = math.copysign(min(abs(yaw), abs(wrapped(turn)) / top_turn), yaw)
    if way.distance < 1e-6:
        return 0.0, 0.0, yaw
    share = min(1.0, way.distance / settings.threshold_damp_xy)
    if far:
        share *= max(0.0, math.cos(turn))  # first turn, then go
    # Along an ellipse, so that it keeps its direction where it is slower sideways than ahead.
    ahead, aside = way.x / way.distance, way.y / way.distance
    share = min(share / math.hypot(ahead / settings.max_vel_x, aside / settings.max_vel_y), way.distance / top)
    return share * ahead, share * aside, yaw


class StuckWatch:
    """Notices that a robot gets no nearer for `limit` s (0: never): it pushes against a wall, or walks on the spot."""

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._best = math.inf
        self._waited, self._checked = 0.0, 0.0

    def check(self, now: float, rest: float) -> None:
        """Note at `now` s that `rest` m of the way are left. Raises NaoError if it has not become less for too long."""
        round_time, self._checked = min(max(0.0, now - self._checked), LONGEST_ROUND), now
        if rest < self._best - PROGRESS or math.isinf(self._best):
            self._best, self._waited = rest, 0.0
            return
        self._waited += round_time
        if self._limit > 0.0 and self._waited > self._limit:
            raise NaoError(
                f"no progress for {self._limit:g} s, with {rest:.2f} m still to go: something is in the way, "
                "or the robot does not walk"
            )
