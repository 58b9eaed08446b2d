"""Places on the floor, with a heading. Pure."""

from __future__ import annotations

import math
from typing import NamedTuple


class Place(NamedTuple):
    """A point on the floor and a heading; also the way that leads there from the origin.

    Attributes:
        x: m, ahead.
        y: m, to the left.
        yaw: rad, positive to the left.
    """

    x: float
    y: float
    yaw: float

    def then(self, way: Place) -> Place:
        """Where a way leads that is told as seen from this place."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Place(self.x + c * way.x - s * way.y, self.y + s * way.x + c * way.y, _wrapped(self.yaw + way.yaw))

    def seen_from(self, other: Place) -> Place:
        """The way from another place to this one, as seen from there."""
        c, s = math.cos(other.yaw), math.sin(other.yaw)
        x, y = self.x - other.x, self.y - other.y
        return Place(c * x + s * y, c * y - s * x, _wrapped(self.yaw - other.yaw))

    @property
    def distance(self) -> float:
        """Of the point from the origin, m."""
        return math.hypot(self.x, self.y)


def _wrapped(angle: float) -> float:
    """The same angle, -pi to pi."""
    return math.remainder(angle, 2.0 * math.pi)
