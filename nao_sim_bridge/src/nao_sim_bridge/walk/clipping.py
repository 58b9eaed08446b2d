"""What a NAO's legs can step: limits of a foot's place beside the other one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import copysign, sqrt
from typing import Sequence, Tuple

from nao_sim_bridge.base.config import array, check_keys
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FILE, walk_file

Box = Sequence[Tuple[float, float]]
# A turn of feet that would overlap is found by halving so often.
TURN_HALVINGS = 6


@dataclass(frozen=True)
class StepLimits:
    """Where a foot may be put beside the other one.

    Attributes:
        max_x: Furthest forward, m.
        min_x: Furthest back, negative, m.
        max_y: Furthest aside, m.
        min_y: Nearest aside, m.
        max_turn: rad.
        left_box: Corners of the outline of the left foot, m.
    """

    max_x: float
    min_x: float
    max_y: float
    min_y: float
    max_turn: float
    left_box: Box

    def box(self, side: int) -> Box:
        """Corners of the outline of a foot, 1 left, -1 right, in its own frame, m."""
        return [(x, side * y) for x, y in self.left_box]


@lru_cache(maxsize=1)
def step_limits() -> StepLimits:
    """The limits of the robot's legs, whatever a gait allows."""
    where = f"{FILE}: clipping"
    keys = ["max_step_x", "min_step_x", "max_step_y", "min_foot_separation", "max_step_theta"]
    content = check_keys(walk_file()["clipping"], where, [*keys, "left_foot_box"])
    box = array(content["left_foot_box"], f"{where}.left_foot_box", (4, 2)).tolist()
    return StepLimits(*(float(content[key]) for key in keys), [tuple(corner) for corner in box])


def clip_step(placement: FootPose, side: int, limits: StepLimits) -> FootPose:
    """The nearest placement that the legs can step, as NAOqi's walk clips: box, ellipse, then the overlap of the feet.

    It is that of the foot that steps, 1 left, -1 right, in the frame of the other one.
    """
    x = min(max(placement.x, limits.min_x), limits.max_x)
    aside = min(max(side * placement.y, limits.min_y), limits.max_y)
    turn = min(max(placement.yaw, -limits.max_turn), limits.max_turn)
    longest = limits.max_x if x >= 0.0 else -limits.min_x
    across = (aside - limits.min_y) / (limits.max_y - limits.min_y)
    size = sqrt((x / longest) ** 2 + across**2)
    if size > 1.0:
        x, aside = x / size, limits.min_y + (aside - limits.min_y) / size
    clipped = FootPose(x, side * aside, turn)
    if not feet_overlap(clipped, side, limits):
        return clipped
    apart, share = 0.0, 0.5
    for halving in range(2, TURN_HALVINGS + 2):
        over = feet_overlap(clipped._replace(yaw=share * turn), side, limits)
        apart = apart if over else share
        share += -(0.5**halving) if over else 0.5**halving
    return clipped._replace(yaw=apart * turn)


def feet_overlap(placement: FootPose, side: int, limits: StepLimits) -> bool:
    """Whether a foot on the `side` would stand on the other one."""
    moved = [placement.moved(x, y) for x, y in limits.box(side)]
    return _overlap([(p.x, p.y) for p in moved], limits.box(-side))


def _overlap(first: Box, second: Box) -> bool:
    """Whether two convex outlines share a point: no edge of either parts them."""
    for outline in (first, second):
        for (ax, ay), (bx, by) in zip(outline, [*outline[1:], outline[0]]):
            nx, ny = by - ay, ax - bx
            a = [nx * x + ny * y for x, y in first]
            b = [nx * x + ny * y for x, y in second]
            if max(a) <= min(b) or max(b) <= min(a):
                return False
    return True


def spread(turn: float, outer: bool, share: float) -> float:
    """Turn of one of two steps that together turn by twice `turn`: the outer foot takes a share of it."""
    return 2.0 * turn * (share if outer else 1.0 - share)


def sidestep(aside: float, outer: bool, narrowing: float) -> float:
    """Way to the side of one of two steps that together go twice `aside`, m.

    The foot on the outer side goes further: the one that follows comes nearer to it by `narrowing` at most.
    """
    inner = min(abs(aside), narrowing)
    return copysign(2.0 * abs(aside) - inner if outer else inner, aside)
