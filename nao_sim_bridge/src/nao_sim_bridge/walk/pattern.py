"""The pendulum that a walking body is: its divergent component over a plan, in closed form, and what is measured of it.

The centre of mass of a walking robot at height `h` is an inverted pendulum about the zero moment point `p`:
`c'' = w^2 (c - p)` with `w^2 = g / h`. Its divergent part `d = c + c' / w` obeys `d' = w (d - p)` and is unstable
forwards in time, so it is fixed from the end of the plan backwards, segment by segment, exactly.
"""

from __future__ import annotations

from math import exp
from typing import NamedTuple, Sequence, Tuple

Point = Tuple[float, float]


class Segment(NamedTuple):
    """The zero moment point moves in a straight line, m, for a duration, s."""

    duration: float
    start: Point
    end: Point


# Shorter ones are nothing, s.
INSTANT = 1e-6


def divergent_component(segments: Sequence[Segment], end: Point, omega: float) -> Point:
    """Where the divergent component has to be now, so that it comes to rest at `end` after all segments, m."""
    x, y = end
    for duration, (ax, ay), (bx, by) in reversed(segments):
        if duration < INSTANT:
            continue
        decay = exp(-omega * duration)
        mx, my = (bx - ax) / (duration * omega), (by - ay) / (duration * omega)
        x = ax + mx + decay * (x - bx - mx)
        y = ay + my + decay * (y - by - my)
    return x, y


class PendulumObserver:
    """Place and speed of the centre of mass along one axis: a pendulum that is corrected by what is measured.

    It knows between two measurements how the body moves, so that noise need not be filtered by waiting.

    Attributes:
        place: m.
        speed: m/s.

    Args:
        omega: Frequency of the pendulum, rad/s.
        place_gain: Share of the difference to the measured place that is taken over at a tick.
        speed_gain: Share of that difference over the time of a tick that is added to the speed.
    """

    def __init__(self, omega: float, place_gain: float, speed_gain: float) -> None:
        self._omega = omega
        self._place_gain = place_gain
        self._speed_gain = speed_gain
        self.place = 0.0
        self.speed = 0.0

    @property
    def divergent(self) -> float:
        """Divergent component of motion, m."""
        return self.place + self.speed / self._omega

    def reset(self, place: float, speed: float) -> None:
        self.place, self.speed = place, speed

    def update(self, measured: float, pressure: float, dt: float) -> None:
        """Take in a place of the centre of mass, measured `dt` s after the last one, and the planned `pressure`, m."""
        acceleration = self._omega * self._omega * (self.place - pressure)
        self.place += dt * (self.speed + 0.5 * dt * acceleration)
        self.speed += dt * acceleration
        off = measured - self.place
        self.place += self._place_gain * off
        self.speed += self._speed_gain * off / dt
