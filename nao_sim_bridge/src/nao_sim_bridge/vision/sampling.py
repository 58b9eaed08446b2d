"""Brightness between pixels."""

from __future__ import annotations

import cv2
import numpy as np


def sample(grey: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Brightness at places in a picture, as at its edge for those outside.

    Args:
        grey: (h, w) uint8 or float32.
        places: (n, m, 2) in pixels, (0.5, 0.5) is the middle of the first one.

    Returns:
        (n, m) float32.
    """
    where = (places - 0.5).astype(np.float32)
    values = cv2.remap(grey, where[..., 0], where[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return values.astype(np.float32)
