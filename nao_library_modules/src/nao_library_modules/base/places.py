"""Places on the floor, with a heading. Pure functions; lengths in m, angles in rad."""

from __future__ import annotations

import math
from typing import NamedTuple

BASE_LINK, FOOTPRINT, ODOM = "base_link", "base_footprint", "odom"
"""Names of frames where nothing else is asked for, as in REP 105 and 120."""


class Place(NamedTuple):
    """A point on the floor and a heading; also the way that leads there from the origin."""

    x: float  # m
    y: float  # m
    yaw: float  # rad, positive to the left

    def then(self, way: Place) -> Place:
        """Where `way`, which is told in the frame of this place, leads."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Place(self.x + c * way.x - s * way.y, self.y + s * way.x + c * way.y, wrapped(self.yaw + way.yaw))

    def seen_from(self, other: Place) -> Place:
        """This place in the frame of another: the way from there to here."""
        c, s = math.cos(other.yaw), math.sin(other.yaw)
        x, y = self.x - other.x, self.y - other.y
        return Place(c * x + s * y, c * y - s * x, wrapped(self.yaw - other.yaw))

    def inverse(self) -> Place:
        """The origin seen from here: `place.then(place.inverse())` is the origin."""
        return ORIGIN.seen_from(self)

    @property
    def distance(self) -> float:
        """Of the point from the origin, m."""
        return math.hypot(self.x, self.y)

    def distance_to(self, other: Place) -> float:
        """Between the two points, m; headings do not count."""
        return math.hypot(self.x - other.x, self.y - other.y)


ORIGIN = Place(0.0, 0.0, 0.0)


def wrapped(angle: float) -> float:
    """The same angle, above -pi to pi."""
    turns = math.ceil((angle - math.pi) / (2.0 * math.pi))
    return angle - 2.0 * math.pi * turns


def yaw_of_quaternion(x: float, y: float, z: float, w: float) -> float | None:
    """Heading of the X axis that a quaternion turns; None for one that is no rotation, such as four zeros."""
    square = x * x + y * y + z * z + w * w
    if not math.isfinite(square) or square < 1e-6:
        return None
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)
