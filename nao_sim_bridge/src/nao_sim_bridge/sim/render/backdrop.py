"""Floor, shadow and horizon of a picture, drawn with arrays instead of triangles.

The software renderer spends most of its time on the many pixels of a floor, and has neither tiles nor soft shadows.
A plane needs no triangles: each pixel's ray meets it where a little arithmetic says.
"""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.sim.render.scene import Camera
from nao_sim_bridge.sim.world import World

SHADE = 0.42
"""Share of the light that a shadow takes away."""
HAZE_DISTANCE = 5.0
"""Distance in m at which most of the floor's colour has gone over into that of the horizon."""


def pixel_rays(camera: Camera) -> np.ndarray:
    """(h, w, 3) float32 directions in world of the rays through the pixel centres; not of unit length."""
    forward = np.subtract(camera.target, camera.eye).astype(float)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    tangent = np.tan(camera.fov / 2.0)
    vertical = (1.0 - (2.0 * np.arange(camera.height) + 1.0) / camera.height) * tangent
    horizontal = ((2.0 * np.arange(camera.width) + 1.0) / camera.width - 1.0) * tangent
    horizontal *= camera.width / camera.height
    rays = forward + vertical[:, None, None] * up + horizontal[None, :, None] * right
    return rays.astype(np.float32)


def draw_backdrop(camera: Camera, world: World, shadow: Shadow | None) -> np.ndarray:
    """(h, w, 3) float32 picture in 0..1 of the world without robot and objects."""
    rays = pixel_rays(camera)
    slope = rays[..., 2]
    height = np.float32(camera.eye[2])
    horizon = np.array(world.background.horizon, dtype=np.float32)
    top = np.array(world.background.top, dtype=np.float32)
    share = np.clip(slope * np.float32(1.6), 0.0, 1.0)[..., None]
    picture = horizon * (1.0 - share) + top * share
    if height <= 0.0:
        return picture
    rows, columns = np.nonzero(slope < -1e-4)
    ray = rays[rows, columns]
    scale = -height / ray[:, 2]
    x = np.float32(camera.eye[0]) + scale * ray[:, 0]
    y = np.float32(camera.eye[1]) + scale * ray[:, 1]
    # The width of a pixel on the floor in tiles: where tiles get smaller than pixels they fade into one colour.
    tile = np.float32(world.floor.tile_size)
    pixel = np.float32(2.0 * np.tan(camera.fov / 2.0) / camera.height)
    blurred = scale * scale * pixel / (height * tile)
    contrast = np.clip(1.6 - 3.0 * blurred, 0.0, 1.0)
    odd = ((np.floor(x / tile) + np.floor(y / tile)) % 2.0).astype(np.float32)
    mix = (0.5 + (odd - 0.5) * contrast)[:, None]
    color = np.array(world.floor.color, dtype=np.float32)
    tile_color = np.array(world.floor.tile_color, dtype=np.float32)
    ground = color * (1.0 - mix) + tile_color * mix
    if shadow is not None:
        ground *= (1.0 - np.float32(SHADE) * shadow.at(x, y))[:, None]
    haze = (1.0 - np.exp(-((scale / HAZE_DISTANCE) ** 2)))[:, None]
    picture[rows, columns] = ground * (1.0 - haze) + horizon * haze
    return picture


class Shadow:
    """What lies in shadow on the floor, as the lamp sees it.

    Args:
        covered: (n, n) whether something is in the way, seen from the lamp, first row on top.
        view_projection: (4, 4) from world to the lamp's clip coordinates.
        softness: Radius of the blur, in pixels of `covered`.
    """

    def __init__(self, covered: np.ndarray, view_projection: np.ndarray, softness: int = 2) -> None:
        self._map = blur(covered.astype(np.float32), softness)
        self._matrix = view_projection.astype(np.float32)

    def at(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Darkness in 0..1 of floor points (m, in world)."""
        m, size = self._matrix, self._map.shape[0]
        depth = m[3, 0] * x + m[3, 1] * y + m[3, 3]
        column = ((m[0, 0] * x + m[0, 1] * y + m[0, 3]) / depth * 0.5 + 0.5) * size - 0.5
        row = (0.5 - (m[1, 0] * x + m[1, 1] * y + m[1, 3]) / depth * 0.5) * size - 0.5
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
    if radius < 1:
        return image
    width = 2 * radius + 1
    for axis in (0, 1) * passes:
        padding = [(0, 0)] * image.ndim
        padding[axis] = (radius + 1, radius)
        sums = np.cumsum(np.pad(image, padding, mode="edge"), axis=axis, dtype=np.float32)
        ends = [slice(None)] * image.ndim
        starts = list(ends)
        ends[axis], starts[axis] = slice(width, None), slice(None, -width)
        image = (sums[tuple(ends)] - sums[tuple(starts)]) / np.float32(width)
    return image
