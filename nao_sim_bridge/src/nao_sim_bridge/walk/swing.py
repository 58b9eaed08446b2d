"""The way of a foot through the air."""

from __future__ import annotations

from math import atan2, cos, pi, sin
from typing import NamedTuple

from nao_sim_bridge.walk.footsteps import FootPose


class FootInAir(NamedTuple):
    """A foot on its way.

    Attributes:
        pose: Over the ground.
        height: Of the sole over the ground, m.
    """

    pose: FootPose
    height: float


def swing(start: FootPose, end: FootPose, share: float, lift: float) -> FootInAir:
    """Where the foot is.

    It goes forward with the least jerk and up and down as a cosine, at rest at both ends.

    Args:
        start: Where it took off.
        end: Where it lands.
        share: Of its time in the air, 0..1.
        lift: Peak, m.
    """
    u = min(max(share, 0.0), 1.0)
    s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
    turn = end.yaw - start.yaw
    turn = atan2(sin(turn), cos(turn))
    pose = FootPose(start.x + s * (end.x - start.x), start.y + s * (end.y - start.y), start.yaw + s * turn)
    return FootInAir(pose, 0.5 * lift * (1.0 - cos(2.0 * pi * u)))
