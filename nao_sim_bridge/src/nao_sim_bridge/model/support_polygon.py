"""Distance of a point from the support polygon. Pure functions of points in the plane."""

from __future__ import annotations

import math
from typing import Sequence, Tuple

Point = Tuple[float, float]


def outside(corners: Sequence[Point], point: Point) -> tuple[float, Point]:
    """How far a point is outside a convex polygon.

    Args:
        corners: Of the polygon, counter-clockwise, at least three, m.
        point: m.

    Returns:
        Distance in m, negative inside, and the unit vector that leads out on the shortest way.
    """
    x, y = point
    deepest, way = -math.inf, (0.0, 0.0)
    nearest, direction = math.inf, (0.0, 0.0)
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]]):
        ex, ey = bx - ax, by - ay
        length = math.hypot(ex, ey)
        normal = (ey / length, -ex / length)
        height = (x - ax) * normal[0] + (y - ay) * normal[1]
        if height > deepest:
            deepest, way = height, normal
        share = min(max(((x - ax) * ex + (y - ay) * ey) / length**2, 0.0), 1.0)
        dx, dy = x - ax - share * ex, y - ay - share * ey
        distance = math.hypot(dx, dy)
        if 0.0 < distance < nearest:
            nearest, direction = distance, (dx / distance, dy / distance)
    return (deepest, way) if deepest <= 0.0 else (nearest, direction)
