"""Leads a robot along a course, round by round, until it is there. No ROS: legs, location and clock are given."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...base.clock import WallClock
from ...base.places import Place
from ..base.rate import Rate
from .courses import Aim, reached
from .settings import FollowerSettings
from .steering import StuckWatch, velocity

if TYPE_CHECKING:
    from .legs import WalkTopics

RESEND_DISTANCE, RESEND_TURN = 0.02, math.radians(4.0)
"""m and rad that the aim moves before the robot gets it: it plans its steps anew each time."""
GRACE, WALL_GRACE = 1.0, 0.25
"""s from a command until the robot must be seen to walk; simulated time may be fast, so of real time as well."""
SETTLE = 3.0
"""s that a robot which is near enough may go on, to get nearer, before it is stopped."""
FASTEST_ROUND = 0.008
"""s of real time from one round to the next at least, however fast simulated time runs."""


def _check_stop(legs: WalkTopics) -> None:
    """Give up a walk that a protection of the robot has ended: each new try would get nearer to what is in the way."""
    cause = legs.why_stopped()
    if cause:
        raise NaoError(f"the robot stopped: {cause}")


class _Mode:
    """A way to lead; `round` does what is to be done now, and returns whether the robot has arrived and stands."""

    def __init__(
        self, legs: WalkTopics, settings: FollowerSettings, now: Callable[[], float], interrupt: CancellationToken
    ) -> None:
        self._legs = legs
        self._interrupt = interrupt
        self._settings = settings
        self._now = now
        self._wall = WallClock()


class _Poses(_Mode):
    """Leads by poses: the robot plans its steps to each aim, and gets a new one when the aim has moved."""

    def __init__(self, *shared: Any) -> None:
        super().__init__(*shared)
        self._sent: Aim | None = None
        self._sent_at = (-math.inf, -math.inf)
        self._near_since: float | None = None

    def round(self, robot: Place, aim: Aim) -> bool:
        way = aim.place.seen_from(robot)
        near = aim.final and reached(way, self._settings)
        walking = self._legs.walking()
        now = self._now()
        if near:
            self._near_since = now if self._near_since is None else self._near_since
            if walking and now - self._near_since > SETTLE:
                self._legs.stop()
                return True
            if not walking and not self._just_sent(now):
                return True
        else:
            self._near_since = None
            if not walking:
                _check_stop(self._legs)
        if self._moved(aim):
            self._send(way, aim, now)
        elif not (near or walking or self._just_sent(now)):
            self._legs.prepare(self._interrupt)  # says why it does not walk, if it knows
            self._send(way, aim, now)
        return False

    def _send(self, way: Place, aim: Aim, now: float) -> None:
        self._legs.go_to(way)
        self._sent, self._sent_at = aim, (now, self._wall.now())

    def _moved(self, aim: Aim) -> bool:
        if self._sent is None or aim.final != self._sent.final:
            return True
        change = aim.place.seen_from(self._sent.place)
        return change.distance > RESEND_DISTANCE or abs(change.yaw) > RESEND_TURN

    def _just_sent(self, now: float) -> bool:
        return now - self._sent_at[0] < GRACE or self._wall.now() - self._sent_at[1] < WALL_GRACE


class _Velocities(_Mode):
    """Leads by velocities, each round anew."""

    def __init__(self, *shared: Any) -> None:
        super().__init__(*shared)
        self._seen_at = (self._now(), self._wall.now())

    def round(self, robot: Place, aim: Aim) -> bool:
        way = aim.place.seen_from(robot)
        if aim.final and reached(way, self._settings):
            self._legs.stop()
            return True
        now, wall = self._now(), self._wall.now()
        if self._legs.walking():
            self._seen_at = (now, wall)
        else:
            _check_stop(self._legs)
            if now - self._seen_at[0] > GRACE and wall - self._seen_at[1] > WALL_GRACE:
                self._legs.prepare(self._interrupt)
                self._seen_at = (now, wall)
        self._legs.go_at(*velocity(way, self._settings))
        return False


def lead(
    course: Any,
    legs: WalkTopics,
    locate: Callable[[], Place],
    clock: Any,
    settings: FollowerSettings,
    interrupt: CancellationToken,
    report: Callable[[Place, Aim], None] = lambda robot, aim: None,
) -> None:
    """Walk until the course ends; `report` gets in every round the place of the robot, and its aim.

    `locate` gives the place of the robot in the frame of the course. The legs are not stopped when an error ends the
    walk. Raises NaoError if the robot cannot walk, cannot be located or is stuck; Preempted, or whatever reason the
    interrupt has.
    """
    rate = Rate(clock, 1.0 / settings.controller_frequency, FASTEST_ROUND, interrupt)
    stuck = StuckWatch(settings.stuck_time)
    mode = (_Velocities if settings.use_vel_ctrl else _Poses)(legs, settings, clock.now, interrupt)
    prepared = False
    while rate.wait():
        robot = locate()
        aim = course.aim(robot)
        report(robot, aim)
        there = aim.final and reached(aim.place.seen_from(robot), settings)
        if not prepared:
            if there and not legs.walking():
                return
            legs.prepare(interrupt)
            prepared = True
            continue  # that took a while: look again
        if mode.round(robot, aim):
            return
        if not there:  # else it ends its last steps, which takes a while where time is slow
            stuck.check(clock.now(), aim.rest)
    interrupt.check()
