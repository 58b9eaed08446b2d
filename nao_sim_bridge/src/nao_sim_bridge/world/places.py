"""Where robots stand when a simulation starts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

from nao_sim_bridge.base.errors import BadValue

MOST_ROBOTS = 8
"""Robots in one world, at most."""
FURTHEST = 50.0
"""Coordinate of a place, m, at most."""
NEAREST = 0.35
"""Distance of two places, m, at least: arms and feet of two robots do not overlap then."""
RINGS = 3
"""How far around a place another one is looked for, in steps of that distance."""
CIRCLE = 1.0
"""Radius of the circle on which robots stand that nobody gave a place, m."""


@dataclass(frozen=True)
class RobotPlace:
    """A place on the floor, or over it on something that stands there.

    Attributes:
        x: Of the torso, in world, m.
        y: Of the torso, in world, m.
        yaw: Heading over the floor, rad: 0 looks along X.
        z: Of what it stands on, over the floor, m.

    Raises:
        BadValue: A number is not in its range.
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    z: float = 0.0

    def __post_init__(self) -> None:
        if not (max(abs(self.x), abs(self.y)) <= FURTHEST and 0.0 <= self.z <= FURTHEST and math.isfinite(self.yaw)):
            allowed = f"x and y within {FURTHEST:g} m, yaw finite, z 0 to {FURTHEST:g} m"
            raise BadValue("place of a robot (x, y, yaw, z)", (self.x, self.y, self.yaw, self.z), allowed)


ORIGIN = RobotPlace()


def on_circle(count: int) -> tuple[RobotPlace, ...]:
    """Places from which robots look at the middle between them; one alone stands at the origin."""
    if count == 1:
        return (ORIGIN,)
    # The first one looks along X.
    angles = [math.pi + 2.0 * math.pi * number / count for number in range(count)]
    return tuple(
        RobotPlace(
            round(CIRCLE * math.cos(angle), 6),
            round(CIRCLE * math.sin(angle), 6),
            math.remainder(angle - math.pi, 2.0 * math.pi),
        )
        for angle in angles
    )


def places_around(place: RobotPlace) -> list[tuple[float, float]]:
    """A place, and others around it, the nearest first: x, y in m."""
    around = [(place.x, place.y)]
    for ring in range(1, RINGS + 1):
        for number in range(8):
            angle = place.yaw + number * math.pi / 4.0
            around.append((place.x + ring * NEAREST * math.cos(angle), place.y + ring * NEAREST * math.sin(angle)))
    return around


def parse_places(text: str) -> tuple[RobotPlace, ...]:
    """Places from a command line: "x,y,heading; x,y,heading; ..." in m and deg; no heading is 0.

    Raises:
        BadValue: The text is something else.
    """
    places = []
    for part in text.split(";"):
        try:
            numbers = [float(word) for word in part.split(",")]
        except ValueError:
            numbers = []
        if not 2 <= len(numbers) <= 3:
            raise BadValue("places", text, "x,y,heading of each robot in m and deg, with ; between them")
        x, y, heading = (*numbers, 0.0)[:3]
        places.append(RobotPlace(x, y, math.radians(heading)))
    return tuple(places)


def checked_places(places: Sequence[RobotPlace], count: int) -> tuple[RobotPlace, ...]:
    """The first `count` of the places.

    Raises:
        BadValue: There are too few, they are too near to each other, or `count` is out of range.
    """
    if not 1 <= count <= MOST_ROBOTS:
        raise BadValue("robots", count, f"1 to {MOST_ROBOTS}")
    if len(places) < count:
        raise BadValue("places", len(places), f"one for each of the {count} robots")
    wanted = tuple(places[:count])
    for number, place in enumerate(wanted):
        for other in wanted[:number]:
            distance = math.hypot(place.x - other.x, place.y - other.y)
            if distance < NEAREST:
                raise BadValue("distance of two places", round(distance, 3), f"{NEAREST:g} m or more")
    return wanted
