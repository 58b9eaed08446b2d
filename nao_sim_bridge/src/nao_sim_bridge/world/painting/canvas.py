"""A canvas for soft shapes: masks of 0..1 over a grid, and colours that are laid on through them."""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np


class Canvas:
    """A picture that grows layer by layer.

    Attributes:
        x: (h, w) place of each pixel, to the right.
        y: (h, w) place of each pixel, upwards.
        rgb: (h, w, 3) float32 in 0..1.

    Args:
        unit: Pixels of length 1.
        origin: Column and row of the point (0, 0), in pixels.
        color: To begin with, (r, g, b) in 0..1.
    """

    def __init__(
        self, width: int, height: int, unit: float, origin: tuple[float, float], color: Sequence[float]
    ) -> None:
        columns = (np.arange(width, dtype=np.float32) + 0.5 - origin[0]) / unit
        rows = (origin[1] - np.arange(height, dtype=np.float32) - 0.5) / unit
        self.x, self.y = np.meshgrid(columns, rows)
        self.rgb = np.empty((height, width, 3), np.float32)
        self.rgb[:] = color
        self._edge = 1.0 / unit

    def lay(self, mask: np.ndarray, color: Sequence[float], strength: float = 1.0) -> None:
        """Lay a colour on, as far as the mask goes."""
        near = _where_any(mask)
        part = self.rgb[near]
        part += (mask[near] * np.float32(strength))[..., None] * (np.asarray(color, np.float32) - part)

    def shade(self, mask: np.ndarray, factor: float | Sequence[float]) -> None:
        """Make darker (below 1) or brighter (above 1), as far as the mask goes."""
        near = _where_any(mask)
        self.rgb[near] *= 1.0 + mask[near][..., None] * (np.asarray(factor, np.float32) - 1.0)

    def ellipse(
        self, x: float, y: float, half_width: float, half_height: float, tilt: float = 0.0, soft: float = 0.0
    ) -> np.ndarray:
        """Mask of an ellipse.

        Args:
            tilt: Of its X over that of the canvas, rad.
            soft: Width of the edge as a share of the smaller half axis; 0 for one pixel.
        """
        smaller = min(half_width, half_height)
        # What is soft reaches beyond the edge by half of that.
        reach = max(half_width, half_height) * (1.0 + max(soft, self._edge / smaller))
        mask = np.zeros_like(self.x)
        near = self._near((x - reach, x + reach), (y - reach, y + reach))
        c, s = math.cos(tilt), math.sin(tilt)
        dx, dy = self.x[near] - x, self.y[near] - y
        away = np.hypot((c * dx + s * dy) / half_width, (c * dy - s * dx) / half_height)
        mask[near] = self.inside((1.0 - away) * smaller, soft * smaller)
        return mask

    def inside(self, depth: np.ndarray, soft: float = 0.0) -> np.ndarray:
        """Mask of where a signed depth (positive inside) is above 0, with an edge of `soft` or of a pixel."""
        width = max(soft, self._edge)
        share = np.clip(depth / width + 0.5, 0.0, 1.0)
        return share * share * (3.0 - 2.0 * share)

    def stroke(self, points: Sequence[tuple[float, float]], widths: Sequence[float], soft: float = 0.0) -> np.ndarray:
        """Mask of a line through points, with a half width at each of them."""
        reach = max(widths) + max(soft, self._edge)
        xs, ys = zip(*points)
        mask = np.zeros_like(self.x)
        near = self._near((min(xs) - reach, max(xs) + reach), (min(ys) - reach, max(ys) + reach))
        x, y = self.x[near], self.y[near]
        depth = np.full_like(x, -np.inf)
        for (x0, y0), (x1, y1), w0, w1 in zip(points, points[1:], widths, widths[1:]):
            ax, ay = x1 - x0, y1 - y0
            along = np.clip(((x - x0) * ax + (y - y0) * ay) / max(ax * ax + ay * ay, 1e-9), 0.0, 1.0)
            np.maximum(depth, w0 + along * (w1 - w0) - np.hypot(x - x0 - along * ax, y - y0 - along * ay), out=depth)
        mask[near] = self.inside(depth, soft)
        return mask

    def _near(self, across: tuple[float, float], up: tuple[float, float]) -> tuple[slice, slice]:
        """The pixels of a rectangle."""
        columns = np.searchsorted(self.x[0], across)
        rows = np.searchsorted(-self.y[:, 0], (-up[1], -up[0]))
        return slice(rows[0], rows[1]), slice(columns[0], columns[1])

    def pixels(self) -> np.ndarray:
        """The picture, (h, w, 3) uint8."""
        return (np.clip(self.rgb, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def _where_any(mask: np.ndarray) -> tuple[slice, slice]:
    """The rectangle outside of which a mask is 0: most of them are small."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return slice(0, 0), slice(0, 0)
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)


def arch(half_width: float, middle: float, ends: float, count: int = 9) -> list[tuple[float, float]]:
    """Points of a parabola from left to right, in the units of the arguments.

    Args:
        middle: Height at the middle.
        ends: Height at both ends.
    """
    steps = np.linspace(-1.0, 1.0, count)
    return [(float(half_width * t), float(middle + (ends - middle) * t * t)) for t in steps]


def grain(shape: tuple[int, int], seed: int, coarse: tuple[int, int] = (1, 1)) -> np.ndarray:
    """Smooth noise of mean 0 and about 1 at most; `coarse` is the size of its grains in pixels, down and across."""
    rows, columns = (max(2, math.ceil(size / step) + 1) for size, step in zip(shape, coarse))
    few = np.random.default_rng(seed).uniform(-1.0, 1.0, (rows, columns)).astype(np.float32)
    down = np.linspace(0.0, rows - 1.001, shape[0])
    across = np.linspace(0.0, columns - 1.001, shape[1])
    r, c = down.astype(int), across.astype(int)
    fr, fc = (down - r)[:, None].astype(np.float32), (across - c)[None, :].astype(np.float32)
    upper = few[r][:, c] * (1 - fc) + few[r][:, c + 1] * fc
    lower = few[r + 1][:, c] * (1 - fc) + few[r + 1][:, c + 1] * fc
    return upper * (1 - fr) + lower * fr
