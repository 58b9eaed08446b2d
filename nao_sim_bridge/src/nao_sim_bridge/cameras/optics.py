"""How angles and places in the picture belong together: an exact pinhole, as the pictures are drawn.

Angles are NAOqi's: alpha is positive to the left, beta positive downwards, both 0 in the middle of the picture, rad.
Places in the picture are normalised: (0, 0) is its upper left corner and (1, 1) the lower right one.

NAOqi itself takes angles for proportional to places, which is nearly a degree wrong half way to the edge. Here a
bearing is what geometry says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Tuple

import numpy as np

from nao_sim_bridge.model.model_reader import load_model

Pair = Tuple[float, float]


@dataclass(frozen=True)
class Intrinsics:
    """Numbers of the pinhole for one size of picture, in pixels; the centre of the first pixel is at (0.5, 0.5)."""

    fx: float
    fy: float
    cx: float
    cy: float


@dataclass(frozen=True)
class Optics:
    """A pinhole of a horizontal and a vertical field of view, rad."""

    hfov: float
    vfov: float

    @property
    def fov(self) -> Pair:
        """Horizontal and vertical field of view, rad."""
        return self.hfov, self.vfov

    @property
    def _tangents(self) -> Pair:
        """Of half the horizontal and half the vertical field of view."""
        return math.tan(self.hfov / 2.0), math.tan(self.vfov / 2.0)

    def intrinsics(self, width: int, height: int) -> Intrinsics:
        """Focal lengths and centre for a size of picture, in pixels."""
        across, down = self._tangents
        return Intrinsics(width / 2.0 / across, height / 2.0 / down, width / 2.0, height / 2.0)

    def angles(self, x: float, y: float) -> Pair:
        """(alpha, beta) of a normalised place in the picture."""
        across, down = self._tangents
        return math.atan((1.0 - 2.0 * x) * across), math.atan((2.0 * y - 1.0) * down)

    def place(self, alpha: float, beta: float) -> Pair:
        """Normalised place (x, y) in the picture of two angles, each below a right angle."""
        across, down = self._tangents
        return 0.5 - math.tan(alpha) / across / 2.0, 0.5 + math.tan(beta) / down / 2.0

    def angular_size(self, width: float, height: float) -> Pair:
        """Angles, rad, of something in the middle of the picture with a normalised size."""
        across, down = self._tangents
        return 2.0 * math.atan(width * across), 2.0 * math.atan(height * down)

    def image_size(self, width: float, height: float) -> Pair:
        """Normalised size of something in the middle of the picture that fills two angles, rad."""
        across, down = self._tangents
        return math.tan(width / 2.0) / across, math.tan(height / 2.0) / down

    def ray(self, x: float, y: float) -> np.ndarray:
        """(3,) unit vector in the camera's frame (X ahead, Y left, Z up) to a normalised place in the picture."""
        across, down = self._tangents
        direction = np.array((1.0, (1.0 - 2.0 * x) * across, (1.0 - 2.0 * y) * down))
        return direction / np.linalg.norm(direction)

    def project(self, point: np.ndarray) -> Pair | None:
        """Normalised place of a (3,) point in the camera's frame, m; None when it is not in front of the camera."""
        if point[0] <= 0.0:
            return None
        across, down = self._tangents
        return float(0.5 - point[1] / point[0] / across / 2.0), float(0.5 - point[2] / point[0] / down / 2.0)


class CameraOptics(Optics):
    """The optics of one camera of a robot, 0 top or 1 bottom."""

    def __init__(self, version: str = "V6", index: int = 0) -> None:
        camera = next(camera for camera in load_model(version).cameras if camera.index == index)
        super().__init__(camera.horizontal_fov, camera.vertical_fov)
