"""The region over which the centre of mass must stay: the support polygon, drawn in by a margin. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, Sequence

import numpy as np

from nao_sim_bridge.model.body_mass import convex_hull
from nao_sim_bridge.model.robot_model import RobotModel

# Distance to keep from the edge of the support polygon, m.
MARGIN = 0.035
# What of a sole is ahead of this, m, does not count: the ankle has not the torque to lean the whole weight on the toes.
FRONT = 0.08
# A small polygon keeps at least this share of the way from its centre to its nearest edge.
CORE = 0.4


@dataclass(frozen=True, eq=False)
class BalanceRegion:
    """A convex region of the ground, as half planes: `normals @ point <= limits`.

    Attributes:
        normals: (n, 2) unit vectors that point out.
        limits: (n,) m.
        center: (2,) where balance is best, m.
    """

    normals: np.ndarray
    limits: np.ndarray
    center: np.ndarray

    def excess(self, point: np.ndarray) -> np.ndarray:
        """(n,) how far a point is beyond each edge, m, negative inside."""
        return self.normals @ point - self.limits


def sole_corners(model: RobotModel, foot: str, pose: np.ndarray) -> np.ndarray:
    """(n, 2) outline on the ground, m, of what counts of the sole of `LLeg` or `RLeg`.

    Args:
        foot: `LLeg` or `RLeg`.
        pose: (4, 4) of the effector under the foot.
    """
    outline = np.minimum(model.sole_polygon(foot[0]), (FRONT, np.inf))
    corners = np.column_stack((outline, np.zeros(len(outline)), np.ones(len(outline))))
    return (pose @ corners.T)[:2].T


def balance_region(corners: Iterable[Sequence[float]]) -> BalanceRegion:
    """The region within the convex hull of `corners` (m, at least three that are not in line)."""
    hull = np.array(convex_hull(corners))
    edges = np.roll(hull, -1, axis=0) - hull
    lengths = np.hypot(edges[:, 0], edges[:, 1])
    normals = np.column_stack((edges[:, 1], -edges[:, 0])) / lengths[:, None]
    center = _centroid(hull)
    limits = (normals * hull).sum(axis=1)
    room = float((limits - normals @ center).min())
    return BalanceRegion(normals, limits - min(MARGIN, (1.0 - CORE) * room), center)


def _centroid(hull: np.ndarray) -> np.ndarray:
    """(2,) centre of the area of a polygon, counter-clockwise."""
    following = np.roll(hull, -1, axis=0)
    areas = hull[:, 0] * following[:, 1] - following[:, 0] * hull[:, 1]
    return ((hull + following) * areas[:, None]).sum(axis=0) / (3.0 * areas.sum())
