"""How dark it is around the robot, and whether its pictures are backlit. Both look at the luminance of pixels only."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Optics

BRIGHT = 110.0
"""Mean luminance of a bright place, 0..255, in a picture that is exposed as in a well-lit room."""
DARKEST = 100
CLIPPED, DIM = 250, 70
"""From the first luminance on a pixel is white but for noise; below the second one it shows little."""
MANY_CLIPPED, MANY_DIM = 0.02, 0.6
"""Shares of a backlit picture that are clipped and dim. Source: NAOqi's description of ALBacklightingDetection."""
NOT_BACKLIT, POSSIBLY_BACKLIT, BACKLIT = range(3)
POSSIBLE = 0.75
"""From this on of 1 a picture may be backlit: half of it counts clipped pixels, half of it dim ones."""


class DarknessDetector:
    """Tells how dark it is, 0 bright to 100 dark."""

    def detect(self, image: np.ndarray, _: Optics, exposed: float) -> int:
        """`exposed`: how many times as bright as in a well-lit room the camera makes its picture, see `Detector`."""
        light = float(_luminance(image).mean()) / exposed
        return round(DARKEST * min(max(1.0 - light / BRIGHT, 0.0), 1.0))


class BacklightingDetector:
    """Tells whether a light behind things leaves them dim: not backlit, possibly, or surely (0, 1, 2)."""

    def detect(self, image: np.ndarray, _: Optics, __: Any = None) -> int:
        """See `Detector`."""
        luminance = _luminance(image)
        clipped, dim = (np.count_nonzero(some) / some.size for some in (luminance >= CLIPPED, luminance < DIM))
        whole = 0.5 * min(clipped / MANY_CLIPPED, 1.0) + 0.5 * min(dim / MANY_DIM, 1.0)
        return BACKLIT if whole >= 1.0 else POSSIBLY_BACKLIT if whole >= POSSIBLE else NOT_BACKLIT


def _luminance(image: np.ndarray) -> np.ndarray:
    """(h, w) uint8 of a (h, w, 3) picture in blue, green, red."""
    return cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
