"""Floor, shadow and horizon of a picture, drawn with arrays instead of triangles.

The software renderer spends most of its time on the many pixels of a floor, and has neither tiles nor soft
shadows. A plane needs no triangles: each pixel's ray meets it where a little arithmetic says.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from nao_sim_bridge.render.scene.view import View
from nao_sim_bridge.world.world import Rug, World

SHADE = 0.42
"""Share of the light that a shadow takes away."""


def covers(rug: Rug, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether a rug lies at points (x, y) of the floor, m."""
    c, s = np.float32(np.cos(rug.yaw)), np.float32(np.sin(rug.yaw))
    dx, dy = x - np.float32(rug.center[0]), y - np.float32(rug.center[1])
    return (np.abs(c * dx + s * dy) <= rug.size[0] / 2.0) & (np.abs(c * dy - s * dx) <= rug.size[1] / 2.0)


class Backdrop:
    """A world with the shadow of what never moves; drawn once for a camera that stays where it is."""

    def __init__(self, world: World, still: Shadow | None = None) -> None:
        self._world = world
        self._still = still
        self._view: tuple | None = None
        self._still_dark: np.ndarray
        self._bright: np.ndarray
        self._shaded: np.ndarray
        self._floor: tuple[np.ndarray, np.ndarray]
        self._points: tuple[np.ndarray, np.ndarray, np.ndarray]

    def draw(self, view: View, shadow: Shadow | None) -> np.ndarray:
        """(h, w, 3) float32 picture in 0..1; the caller may write into it."""
        if view.key != self._view:
            self._look_from(view)
            self._view = view.key
        picture = self._bright.copy()
        if shadow is None:
            return picture
        (rows, columns), (x, y, z) = self._floor, self._points
        near = shadow.reaches(x, y)
        if len(near):
            dark = shadow.at(x[near], y[near], z[near])
            if self._still is not None:
                # Where both fall it gets no darker than the darker one.
                dark = np.maximum(dark - self._still_dark[near], 0.0)
            rows, columns = rows[near], columns[near]
            picture[rows, columns] -= dark[:, None] * self._shaded[near]
        return picture

    def _look_from(self, view: View) -> None:
        """Prepare sky, lit floor, and what a full shadow takes from each floor pixel."""
        world = self._world
        rays = view.rays()
        normal = np.array(world.floor.normal, dtype=np.float32)
        slope = rays @ normal
        horizon = np.array(world.background.horizon, dtype=np.float32)
        top = np.array(world.background.top, dtype=np.float32)
        share = np.clip(slope * np.float32(1.6), 0.0, 1.0)[..., None]
        self._bright = horizon * (1.0 - share) + top * share
        eye = view.eye.astype(np.float32)
        height = eye @ normal
        rows, columns = np.nonzero(slope < (-1e-4 if height > 0.0 else -np.inf))
        scale = -height / slope[rows, columns]
        x, y, z = (eye[:, None] + scale * rays[rows, columns].T).astype(np.float32)
        # The width of a pixel on the floor in tiles: tiles smaller than pixels fade into one colour.
        tile = np.float32(world.floor.tile_size)
        pixel = np.float32(2.0 * view.tangents[1] / view.height)
        contrast = np.clip(1.6 - 3.0 * scale * scale * pixel / (height * tile), 0.0, 1.0)
        odd = (np.floor(x / tile) + np.floor(y / tile)).astype(np.int32) & 1
        mix = (0.5 + (odd - np.float32(0.5)) * contrast)[:, None]
        color = np.array(world.floor.color, dtype=np.float32)
        tile_color = np.array(world.floor.tile_color, dtype=np.float32)
        ground = color + (tile_color - color) * mix
        for rug in world.floor.rugs:
            ground[covers(rug, x, y)] = rug.color
        haze = (1.0 - np.exp(-np.square(scale / np.float32(world.background.haze))))[:, None]
        self._bright[rows, columns] = ground + (horizon - ground) * haze
        self._shaded = ground * (np.float32(SHADE) * (1.0 - haze))
        self._floor, self._points = (rows, columns), (x, y, z)
        if self._still is not None:
            self._still_dark = self._still.at(x, y, z)
            self._bright[rows, columns] -= self._still_dark[:, None] * self._shaded


class Shadow:
    """What lies in shadow on the floor, as the lamp sees it.

    Args:
        covered: (n, n) whether something is in the way, seen from the lamp, first row on top.
        view_projection: (4, 4) from world to the lamp's clip coordinates.
        center: (2,) middle of the area it knows, m.
        reach: Half the width of that area, m.
        softness: Radius of the blur, in pixels of `covered`.
    """

    def __init__(
        self,
        covered: np.ndarray,
        view_projection: np.ndarray,
        center: Sequence[float],
        reach: float,
        softness: int = 2,
    ) -> None:
        self._map = blur(covered.astype(np.float32), softness)
        self._matrix = view_projection.astype(np.float32)
        self._center = np.float32(center[0]), np.float32(center[1])
        self._reach = np.float32(reach)

    def reaches(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Indices of the floor points (m, in world) that may lie in shadow."""
        # A low lamp throws shadows farther than what it sees is wide.
        far = 3.0 * self._reach
        return np.flatnonzero((np.abs(x - self._center[0]) < far) & (np.abs(y - self._center[1]) < far))

    def at(self, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Darkness in 0..1 of floor points (m, in world)."""
        m, size = self._matrix, self._map.shape[0]
        right, up, _, depth = (a * x + b * y + c * z + d for a, b, c, d in m)
        column = (right / depth * 0.5 + 0.5) * size - 0.5
        row = (0.5 - up / depth * 0.5) * size - 0.5
        inside = (column >= 0.0) & (column < size - 1) & (row >= 0.0) & (row < size - 1)
        darkness = np.zeros_like(x)
        c, r = column[inside], row[inside]
        c0, r0 = c.astype(np.int32), r.astype(np.int32)
        fc, fr = c - c0, r - r0
        s = self._map
        upper = s[r0, c0] * (1.0 - fc) + s[r0, c0 + 1] * fc
        lower = s[r0 + 1, c0] * (1.0 - fc) + s[r0 + 1, c0 + 1] * fc
        darkness[inside] = upper * (1.0 - fr) + lower * fr
        return darkness


def blur(image: np.ndarray, radius: int, passes: int = 2) -> np.ndarray:
    """An (h, w) or (h, w, c) image averaged over squares of 2 radius + 1 pixels, `passes` times."""
    edges = (2 * radius + 1,) * 2
    for _ in range(passes):
        image = cv2.blur(image, edges, borderType=cv2.BORDER_REPLICATE)
    return image
