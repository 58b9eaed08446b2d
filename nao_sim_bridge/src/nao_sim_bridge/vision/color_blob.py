"""Finds the largest blob of one colour."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Tuple

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Optics

ROUND = 0.7
"""Share of the circle around a round blob that the blob fills at least: holes of highlights are allowed for."""


@dataclass(frozen=True)
class BlobSettings:
    """What to look for.

    Attributes:
        color: Red, green, blue, 0..255.
        threshold: By how much each of them may be off.
        least_pixels: Of the blob.
        round: Whether only what is round counts.
    """

    color: Tuple[int, int, int]
    threshold: int
    least_pixels: int
    round: bool


@dataclass(frozen=True)
class Blob:
    """The circle around a blob, with its centre and its radius normalised: x and radius to the width, y to the height.

    Its direction is alpha, to the left, and beta, downwards, and `angle` is its angular radius; all in rad.
    """

    x: float
    y: float
    radius: float
    alpha: float
    beta: float
    angle: float


class ColorBlobDetector:
    """The largest blob of a colour."""

    def detect(self, image: np.ndarray, optics: Optics, settings: BlobSettings | None) -> Blob | None:
        """None when there is none, or nobody has said which colour; see `Detector`."""
        if settings is None:
            return None
        wanted = np.array(settings.color[::-1], int)
        low, high = (np.clip(wanted + way * settings.threshold, 0, 255).tolist() for way in (-1, 1))
        count, labels, numbers, _ = cv2.connectedComponentsWithStats(cv2.inRange(image, tuple(low), tuple(high)))
        sizes = numbers[:, cv2.CC_STAT_AREA]
        for label in sorted(range(1, count), key=lambda label: -sizes[label]):
            if sizes[label] < settings.least_pixels:
                return None
            outline = cv2.findNonZero((labels == label).astype(np.uint8))
            (x, y), radius = cv2.minEnclosingCircle(outline)
            radius += 0.5  # to the edge of the outermost pixels, whose middle it goes through
            if not settings.round or sizes[label] >= ROUND * math.pi * radius**2:
                return _blob(x + 0.5, y + 0.5, radius, image.shape, optics)
        return None


def _blob(x: float, y: float, radius: float, shape: Tuple[int, ...], optics: Optics) -> Blob:
    height, width = shape[:2]
    alpha, beta = optics.angles(x / width, y / height)
    left, right = (optics.ray((x + way * radius) / width, y / height) for way in (-1, 1))
    angle = 0.5 * math.acos(min(float(left @ right), 1.0))
    return Blob(x / width, y / height, radius / width, alpha, beta, angle)
