"""Poses of feet on the ground, and the way of one through the air."""

from __future__ import annotations

from math import atan2, cos, pi, sin
from typing import NamedTuple

# Feet stand side by side up to this, m, and parallel up to this, rad.
ASIDE, PARALLEL = 0.01, 0.03


class FootPose(NamedTuple):
    """A foot, or the robot, on the ground: m, m, rad."""

    x: float
    y: float
    yaw: float

    def moved(self, x: float, y: float, yaw: float = 0.0) -> FootPose:
        """This pose after a movement in its own frame."""
        c, s = cos(self.yaw), sin(self.yaw)
        return FootPose(self.x + c * x - s * y, self.y + s * x + c * y, self.yaw + yaw)

    def seen_from(self, other: FootPose) -> FootPose:
        """This pose in the frame of another."""
        c, s = cos(other.yaw), sin(other.yaw)
        x, y = self.x - other.x, self.y - other.y
        turn = self.yaw - other.yaw
        return FootPose(c * x + s * y, -s * x + c * y, atan2(sin(turn), cos(turn)))


def side_by_side(left: FootPose, right: FootPose, separation: float) -> bool:
    """Whether two feet stand about as a walk puts them down: beside each other, `separation` m apart, parallel."""
    x, y, yaw = left.seen_from(right)
    return abs(x) < ASIDE and abs(y - separation) < ASIDE and abs(yaw) < PARALLEL


def middle(first: FootPose, second: FootPose) -> FootPose:
    """Half way between two poses, turned half way."""
    turn = second.yaw - first.yaw
    turn = atan2(sin(turn), cos(turn))
    return FootPose((first.x + second.x) / 2.0, (first.y + second.y) / 2.0, first.yaw + turn / 2.0)


class FootInAir(NamedTuple):
    """A foot on its way, the sole at a height over the ground, m."""

    pose: FootPose
    height: float


def swing(start: FootPose, end: FootPose, share: float, lift: float) -> FootInAir:
    """Where the foot is after a share 0..1 of its time in the air; `lift` is the peak, m.

    It goes forward with the least jerk and up and down as a cosine, at rest at both ends.
    """
    u = min(max(share, 0.0), 1.0)
    s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
    turn = end.yaw - start.yaw
    turn = atan2(sin(turn), cos(turn))
    pose = FootPose(start.x + s * (end.x - start.x), start.y + s * (end.y - start.y), start.yaw + s * turn)
    return FootInAir(pose, 0.5 * lift * (1.0 - cos(2.0 * pi * u)))
