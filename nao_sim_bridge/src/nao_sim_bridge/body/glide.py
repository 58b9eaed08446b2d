"""The way of a thing from one pose to another at constant speed. Arithmetic only: times are passed in."""

from __future__ import annotations

import math
from dataclasses import dataclass

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import Quaternion, Vector3


@dataclass(frozen=True)
class Glide:
    """A straight way, with a turn the short way round.

    Attributes:
        start: Where it begins.
        target: Where it ends.
        begin: When, s.
        duration: How long it takes, s.
    """

    start: Pose
    target: Pose
    begin: float
    duration: float

    @property
    def velocity(self) -> Vector3:
        """On the way, in m/s."""
        dx, dy, dz = (b - a for a, b in zip(self.start.position, self.target.position))
        return (dx / self.duration, dy / self.duration, dz / self.duration)

    def ended(self, now: float) -> bool:
        """Whether the end has been reached at a time in s."""
        return now >= self.begin + self.duration - 1e-9

    def at(self, now: float) -> Pose:
        """The pose at a time in s; that of the end afterwards."""
        if self.ended(now):
            return self.target
        share = max(now - self.begin, 0.0) / self.duration
        x, y, z = (a + share * (b - a) for a, b in zip(self.start.position, self.target.position))
        return Pose((x, y, z), slerp(self.start.orientation, self.target.orientation, share))


def slerp(first: Quaternion, second: Quaternion, share: float) -> Quaternion:
    """The orientation at a share 0..1 of the way between two, the short way round."""
    cosine = sum(a * b for a, b in zip(first, second))
    if cosine < 0.0:
        second, cosine = (-second[0], -second[1], -second[2], -second[3]), -cosine
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-6:
        return second
    near, far = (math.sin(part * angle) / math.sin(angle) for part in (1.0 - share, share))
    x, y, z, w = (near * a + far * b for a, b in zip(first, second))
    return (x, y, z, w)
