"""The divergent component of motion over a plan of the zero moment point, in closed form.

The centre of mass of a walking robot at height `h` is an inverted pendulum about the zero moment point `p`:
`c'' = w^2 (c - p)` with `w^2 = g / h`. Its divergent part `d = c + c' / w` obeys `d' = w (d - p)` and is unstable
forwards in time, so it is fixed from the end of the plan backwards, segment by segment, exactly.
"""

from __future__ import annotations

from math import exp
from typing import NamedTuple, Sequence, Tuple

Point = Tuple[float, float]


class Segment(NamedTuple):
    """The zero moment point moves in a straight line.

    Attributes:
        duration: s.
        start: m.
        end: m.
    """

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
