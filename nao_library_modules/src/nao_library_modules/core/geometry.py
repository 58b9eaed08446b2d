"""Places on the floor, rotations, and angles typed in degrees. Pure functions; lengths in m, angles in rad."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Tuple

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


Vector = Tuple[float, float, float]
Quaternion = Tuple[float, float, float, float]


def from_roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Turn about X, then Y, then Z of the fixed frame."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def inverse(q: Quaternion) -> Quaternion:
    return (-q[0], -q[1], -q[2], q[3])


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """First `b`, then `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(q: Quaternion, v: Vector) -> Vector:
    x, y, z, w = q
    tx, ty, tz = 2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])
    return (
        v[0] + w * tx + y * tz - z * ty,
        v[1] + w * ty + z * tx - x * tz,
        v[2] + w * tz + x * ty - y * tx,
    )


def about(axis: Vector, angle: float) -> Quaternion:
    """Turn by `angle` about an axis of length 1."""
    s = math.sin(angle / 2)
    return (axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle / 2))


DEGREES = "deg"
"""Behind a number in a field for angles: 45deg are 0.785 rad."""
ANGLES = frozenset({"angles", "values"})
"""Fields whose numbers are angles in rad, or may be."""


def is_in_degrees(value: Any) -> bool:
    """Whether a text is meant as an angle in degrees."""
    return isinstance(value, str) and value.strip().endswith((DEGREES, "°"))


def in_rad(value: Any) -> float:
    """A number, or an angle in degrees as rad. Raises ValueError if it is neither."""
    try:
        if is_in_degrees(value):
            return math.radians(float(value.strip().replace("°", DEGREES)[: -len(DEGREES)]))
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{value!r} is no number") from None
