"""Round things seen at a slant: ellipses found from outlines and fitted to edges; and brightness between pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Intrinsics


@dataclass(frozen=True, eq=False)
class Ellipse:
    """An ellipse in a picture; pixels, (0.5, 0.5) is the middle of the first one.

    Its shape, (2, 2), takes the points of a unit circle to those of the ellipse, from its centre, (2,).
    """

    center: np.ndarray
    shape: np.ndarray

    @property
    def radii(self) -> tuple[float, float]:
        """Long and short half axis, pixels."""
        (a, b), (c, d) = self.shape.tolist()
        total, both = a * a + b * b + c * c + d * d, 2.0 * abs(a * d - b * c)
        root, rest = math.sqrt(total + both), math.sqrt(max(total - both, 0.0))
        return (root + rest) / 2.0, (root - rest) / 2.0

    @property
    def half_extent(self) -> tuple[float, float]:
        """Half of its width and of its height in the picture, pixels."""
        across, down = np.linalg.norm(self.shape, axis=1)
        return float(across), float(down)

    def points(self, turns: np.ndarray, shares: np.ndarray, slant: np.ndarray | None = None) -> np.ndarray:
        """(n, m, 2) places at (n,) angles, rad clockwise from upwards, and at (m,) shares of the radius.

        `slant` is where in the unit circle its own middle is seen, (2,): perspective moves it when the circle is
        slanted and near. None for no perspective.
        """
        circle = np.stack([np.sin(turns), -np.cos(turns)], axis=-1)
        unit = circle[:, None, :] * shares[None, :, None]
        if slant is not None:
            unit = _seen_slanted(unit, slant)
        return self.center + unit @ self.shape.T

    def slants(self, lens: Intrinsics) -> tuple[np.ndarray, np.ndarray]:
        """(2,) each: where in the unit circle the middle of a circle is seen that looks like this.

        There are two circles in space that do, slanted to opposite sides, and the edge does not tell which it is.
        """
        # The directions to the edge are a cone; the circles are cuts through it. Source: the eigenvectors of a cone
        # give the two planes that cut it in circles, and the middle is the pole of their line at infinity.
        inverse = np.linalg.inv(self.shape)
        metric = inverse.T @ inverse
        side = -metric @ self.center
        rest = np.array([[self.center @ metric @ self.center - 1.0]])
        conic = np.block([[metric, side[:, None]], [side[None, :], rest]])
        matrix = np.array(((lens.fx, 0.0, lens.cx), (0.0, lens.fy, lens.cy), (0.0, 0.0, 1.0)))
        (least, middle, most), axes = np.linalg.eigh(matrix.T @ conic @ matrix)
        steep, flat = math.sqrt(max(0.0, most - middle)), math.sqrt(middle - least)
        found = []
        for sign in (1.0, -1.0):
            normal = steep * axes[:, 2] + sign * flat * axes[:, 0]
            x, y, scale = np.linalg.solve(conic, np.linalg.solve(matrix.T, normal))
            found.append(inverse @ (np.array((x, y)) / scale - self.center))
        return found[0], found[1]


def _seen_slanted(unit: np.ndarray, slant: np.ndarray) -> np.ndarray:
    """Points of a unit circle as perspective moves them: its edge onto itself, its middle to `slant`."""
    amount = float(np.linalg.norm(slant))
    if amount < 1e-6:
        return unit
    along = slant / amount
    across = np.array((-along[1], along[0]))
    first, second = unit @ along, unit @ across
    depth = 1.0 + amount * first
    moved = (first + amount) / depth
    shrunk = second * math.sqrt(1.0 - amount * amount) / depth
    return moved[..., None] * along + shrunk[..., None] * across


def ellipse_of(outline: np.ndarray) -> Ellipse | None:
    """The ellipse closest to an outline, (n, 2) float32 in pixels, of at least five points; None when none is close.

    Of all shapes that take the circle to it, it has the symmetric one: without a turn.
    """
    try:
        (x, y), (first, second), degrees = cv2.fitEllipseDirect(outline)
    except cv2.error:
        return None
    if not (math.isfinite(first) and math.isfinite(second)) or min(first, second) <= 0.0:
        return None
    turn = math.radians(degrees)
    axes = np.array(((math.cos(turn), -math.sin(turn)), (math.sin(turn), math.cos(turn))))
    return Ellipse(np.array((x, y)), axes @ np.diag((first / 2.0, second / 2.0)) @ axes.T)


def distance_from(ellipse: Ellipse, outline: np.ndarray) -> np.ndarray:
    """(n,) signed distances, pixels, about, of (n, 2) points from an ellipse; positive outside."""
    unit = np.linalg.inv(ellipse.shape) @ (outline - ellipse.center).T
    lengths = np.linalg.norm(unit, axis=0)
    nearest = ellipse.shape @ (unit / np.maximum(lengths, 1e-9))
    return np.linalg.norm(nearest, axis=0) * (lengths - 1.0)


def sample(grey: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Brightness, (n, m) float32, at (n, m, 2) places of a (h, w) picture, as at its edge for those outside.

    The picture is uint8 or float32; places are in pixels, (0.5, 0.5) is the middle of the first one.
    """
    where = (places - 0.5).astype(np.float32)
    values = cv2.remap(grey, where[..., 0], where[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return values.astype(np.float32)
