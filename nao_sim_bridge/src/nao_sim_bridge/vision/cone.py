"""A sphere in a picture: the directions to its outline lie on a cone, wherever in the picture it is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

ROUNDS = 4
LEAST_POINTS = 5


@dataclass(frozen=True, eq=False)
class Cone:
    """Directions that all have the same angle to an axis.

    Attributes:
        axis: (3,) unit vector in the frame of the camera: X ahead, Y left, Z up.
        angle: Between the axis and the directions, rad: the angular radius of the sphere.
        residual: Root mean square of how far directions are off, rad; of those that were used.
    """

    axis: np.ndarray
    angle: float
    residual: float

    @property
    def alpha(self) -> float:
        """Direction of the axis seen from above, rad, positive to the left."""
        return math.atan2(self.axis[1], self.axis[0])

    @property
    def beta(self) -> float:
        """Direction of the axis seen from the side, rad, positive downwards."""
        return math.atan2(-self.axis[2], self.axis[0])


def fit_cone(directions: np.ndarray) -> Cone | None:
    """The cone closest to (n, 3) unit vectors, which need not go all the way round; None when they make none."""
    if len(directions) < LEAST_POINTS:
        return None
    middle = directions.mean(axis=0)
    middle /= np.linalg.norm(middle)
    # In the plane across the mean direction, a small cone is nearly a circle: a start for the exact angles.
    left = np.cross((0.0, 0.0, 1.0), middle)
    left /= np.linalg.norm(left)
    up = np.cross(middle, left)
    ahead = directions @ middle
    if np.any(ahead <= 0.1):
        return None
    across = np.stack([directions @ left, directions @ up], axis=1) / ahead[:, None]
    circle = _circle(across)
    if circle is None:
        return None
    center = circle[:2]
    for _ in range(ROUNDS):
        axis = middle + center[0] * left + center[1] * up
        axis /= np.linalg.norm(axis)
        angles = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
        if np.any(angles < 1e-9):
            return None
        # Derivatives of the angles when the axis turns towards left and up.
        gradient = np.stack([directions @ left, directions @ up], axis=1) / -np.sin(angles)[:, None]
        system = np.column_stack([gradient, -np.ones(len(angles))])
        step, *_ = np.linalg.lstsq(system, -angles, rcond=None)
        center = center + step[:2]
        if not np.all(np.isfinite(center)):
            return None
    axis = middle + center[0] * left + center[1] * up
    axis /= np.linalg.norm(axis)
    angles = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
    angle = float(angles.mean())
    return Cone(axis, angle, float(np.sqrt(np.mean((angles - angle) ** 2))))


def _circle(points: np.ndarray) -> np.ndarray | None:
    """(x, y, radius) of the circle through (n, 2) points, by least squares."""
    system = np.column_stack([2.0 * points, np.ones(len(points))])
    solution, _, rank, _ = np.linalg.lstsq(system, np.sum(points**2, axis=1), rcond=None)
    square = solution[2] + solution[0] ** 2 + solution[1] ** 2
    if rank < 3 or square <= 0.0:
        return None
    return np.array([solution[0], solution[1], math.sqrt(square)])
