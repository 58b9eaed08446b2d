"""Masses, centres of mass and the support polygon. Pure functions of the model and of joint angles."""

from __future__ import annotations

import math
from typing import Iterable, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.model.kinematics import link_transforms
from nao_sim_bridge.model.robot_model import Link, RobotModel


def links_of(model: RobotModel, name: str) -> list[Link]:
    """The links behind a name: `Body` all, `Joints` all but the torso, a chain its own, a joint or `Torso` one.

    Raises:
        UnknownName: Nothing with a mass has that name.
    """
    if name == "Body":
        return list(model.links)
    if name == "Joints":
        return [link for link in model.links if link.parent_joint is not None]
    names = model.chains.get(name, (name,))
    found = [link for link in model.links if link.name in names]
    if not found:
        raise UnknownName("body", name, ["Body", "Joints", *model.chains, *(link.name for link in model.links)])
    return found


def mass_of(links: Iterable[Link]) -> float:
    """Mass of links in kg."""
    return float(sum(link.mass for link in links))


def center_of_links(model: RobotModel, links: Sequence[Link], angles: Sequence[float]) -> np.ndarray:
    """(3,) centre of mass of some links in the torso frame, m, at (26,) joint `angles` in rad."""
    poses = link_transforms(model, angles)
    moment = sum(link.mass * (poses[link.name] @ np.append(link.com, 1.0))[:3] for link in links)
    return moment / mass_of(links)


def convex_hull(points: Iterable[Sequence[float]]) -> list[tuple[float, float]]:
    """Corners of the convex hull of points in the plane, counter-clockwise; points on an edge are no corners."""
    ordered = sorted({(float(x), float(y)) for x, y in points})
    if len(ordered) < 3:
        return ordered
    return _half_hull(ordered)[:-1] + _half_hull(ordered[::-1])[:-1]


def _half_hull(ordered: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    hull: list[tuple[float, float]] = []
    for point in ordered:
        while len(hull) > 1 and _turn(hull[-2], hull[-1], point) <= 1e-12:
            hull.pop()
        hull.append(point)
    return hull


def _turn(a: Sequence[float], b: Sequence[float], c: Sequence[float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


Point = Tuple[float, float]


def outside(corners: Sequence[Point], point: Point) -> tuple[float, Point]:
    """How far a point is outside a convex polygon (counter-clockwise), m, negative inside, and the unit vector out."""
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
