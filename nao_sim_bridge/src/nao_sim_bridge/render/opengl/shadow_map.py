"""What the lamp sees: the distances of the nearest surfaces, to tell what lies in shadow."""

from __future__ import annotations

from typing import Any

import numpy as np

MARGIN = 0.02
"""Around what throws shadows, m; the edge of the map must be free, for it goes on for ever."""
FINEST = 0.004
"""Width of a pixel, m; if they were finer, edges of shadows would be hard."""
OFFSET = (1.5, 2.0)
"""Of the distances in the map, against surfaces that shade themselves."""


class ShadowMap:
    """One map.

    Attributes:
        texture: The distances.
        matrix: (4, 4) from world to the map, 0..1 each way.

    Args:
        size: Pixels each way.
        toward_lamp: (3,) unit vector in world.
    """

    def __init__(self, context: Any, size: int, toward_lamp: np.ndarray) -> None:
        self._context = context
        self._least = size * FINEST
        self.texture = context.depth_texture((size, size))
        self.texture.compare_func = "<="
        self.texture.repeat_x = self.texture.repeat_y = False
        self._frame = context.framebuffer(depth_attachment=self.texture)
        side = np.array((0.0, 1.0, 0.0)) if abs(toward_lamp[1]) < 0.9 else np.array((1.0, 0.0, 0.0))
        right = np.cross(side, toward_lamp)
        right /= np.linalg.norm(right)
        self._axes = np.stack([right, np.cross(toward_lamp, right), toward_lamp])
        self.matrix = np.eye(4)
        self.clear()

    def clear(self) -> None:
        """No shadows."""
        self._frame.clear(depth=1.0)

    def fit(self, centers: np.ndarray, radii: np.ndarray) -> np.ndarray:
        """Begin a map of spheres.

        Args:
            centers: (n, 3) of the spheres, m, in world; at least one.
            radii: (n,) of the spheres, m.

        Returns:
            (4, 4) from world to clip coordinates of the map.
        """
        # Right, up, and away from the lamp.
        axes = self._axes * np.array((1.0, 1.0, -1.0))[:, None]
        seen = centers @ axes.T
        reach = radii[:, None] + MARGIN
        low, high = (seen - reach).min(axis=0), (seen + reach).max(axis=0)
        high[:2] = np.maximum(high[:2], low[:2] + self._least)
        matrix = np.eye(4)
        matrix[:3, :3] = axes / (high - low)[:, None]
        matrix[:3, 3] = -low / (high - low)
        self.matrix = matrix
        clip = matrix.copy()
        clip[:3] = 2.0 * clip[:3] - matrix[3]
        return clip

    def begin(self) -> None:
        """Draw into it from now on."""
        self._frame.use()
        self._frame.clear(depth=1.0)
        self._context.polygon_offset = OFFSET

    def end(self) -> None:
        """No longer draw into it."""
        self._context.polygon_offset = (0.0, 0.0)
