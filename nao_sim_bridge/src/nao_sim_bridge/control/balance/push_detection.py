"""Notices when somebody pushes a robot that stands still: its body moves although no joint was told to."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable

from nao_sim_bridge.body.sensors.snapshot import Snapshot

# A standing body that moves faster than this, m/s, was pushed; one slower than the second has come to rest.
PUSHED, AT_REST = 0.04, 0.015
# Body and balance must have been at rest for this time, s, before another push is told.
QUIET_TIME = 0.5
# The push is over, and its energy known, when the speed has fallen below this share of its peak, or after this time, s.
PAST_PEAK, LONGEST = 0.6, 0.5


@dataclass(frozen=True)
class Push:
    """A push.

    Attributes:
        angle: Where it drove the body, rad, 0 ahead, positive to the left.
        energy: Kinetic energy that it gave the body, J.
    """

    angle: float
    energy: float


class PushDetector:
    """Looks at how the body moves, tick by tick; `mass` is that of the robot, kg."""

    def __init__(self, mass: float) -> None:
        self._mass = mass
        self._peak = 0.0
        self._angle = 0.0
        self._since: float | None = None
        self._armed = False
        self._at_rest_since: float | None = None

    def look(self, snapshot: Snapshot, stands_still: Callable[[], bool]) -> Push | None:
        """The push that has ended by now, if any; `stands_still` (no joint moves) is asked only when needed."""
        x, y, _ = snapshot.linear_velocity
        speed = math.hypot(x, y)
        if self._since is not None:
            return self._follow(speed, snapshot)
        if speed < AT_REST:
            self._rest(snapshot.age, stands_still)
            return None
        self._at_rest_since = None
        if speed >= PUSHED:
            if self._armed and stands_still():
                self._since = snapshot.age
                self._take(speed, snapshot)
            self._armed = False
        return None

    def _rest(self, now: float, stands_still: Callable[[], bool]) -> None:
        if self._armed:
            return
        if self._at_rest_since is None:
            self._at_rest_since = now
        elif now - self._at_rest_since >= QUIET_TIME:
            self._armed = stands_still()
            self._at_rest_since = now

    def _follow(self, speed: float, snapshot: Snapshot) -> Push | None:
        if speed >= self._peak:
            self._take(speed, snapshot)
        if speed > PAST_PEAK * self._peak and snapshot.age - self._since < LONGEST:
            return None
        self._since = None
        return Push(self._angle, 0.5 * self._mass * self._peak * self._peak)

    def _take(self, speed: float, snapshot: Snapshot) -> None:
        x, y, _ = snapshot.velocity_in_torso
        self._peak, self._angle = speed, math.atan2(y, x)
