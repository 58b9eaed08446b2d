"""Finds what moves: pixels that differ from the picture of a moment before, in clusters.

A camera that moves changes every pixel, and nothing in the world. So pictures are compared only while the camera has
the same pose; its poses are those that the robot knows from its joints. What is left, the sway of a standing robot by
a part of a pixel, is allowed for: a pixel has to be brighter or darker than everything next to it was.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.imports import Library
from nao_sim_bridge.cameras.optics import Optics

cv2 = Library("cv2")
# By how much of 255 a pixel must have changed, at sensitivity 1 and at sensitivity 0.
FINEST, COARSEST = 8.0, 80.0
# Pictures are compared in this width at most, px: more costs time and finds the noise of the sensor.
WIDTH = 320
# How old the picture is that a new one is compared with, s, or older: in less time, what is slow moves too little.
MOMENT = 0.2
# Share of the picture that a cluster has at least; moving pixels within this share of the width are one cluster.
LEAST_SHARE, GAP = 0.0006, 0.08
# When more than this share of the picture has changed it was the light, or the robot was carried away.
EVERYTHING = 0.7
# By how much the pose of the camera may change between two pictures that are compared, rad and m.
STILL_ANGLE, STILL_SHIFT = 0.0045, 0.004
TOLERANCE = 1e-3
"""Of times, s."""
SKIPPED = 8
"""Every so many pixels are enough to know how bright a picture is."""


@dataclass(frozen=True)
class MovementSettings:
    """What the detector is told with a picture: when it was taken, s, and by which camera.

    At a higher sensitivity, 0..1, a smaller change is enough. The pose of the camera is as the robot knows it: x, y, z
    in m, roll, pitch, yaw in rad.
    """

    sensitivity: float
    time: float
    camera: int
    pose: Tuple[float, ...]


@dataclass(frozen=True)
class MovingCluster:
    """Pixels close together that have changed, and their shares of the picture and of the rectangle around them.

    The direction of their centre of gravity is alpha, to the left, and beta, downwards; the corner is that of the upper
    left corner of the rectangle, and the size its width and height; all in rad.
    """

    alpha: float
    beta: float
    corner: Tuple[float, float]
    size: Tuple[float, float]
    share_of_picture: float
    share_of_rectangle: float


class MovementDetector:
    """Compares each picture with one of a moment before."""

    def __init__(self) -> None:
        self._earlier: deque[tuple[float, np.ndarray]] = deque()
        self._seen_from: tuple[int, Sequence[float]] | None = None

    def reset(self) -> None:
        """Forget the pictures before."""
        self._earlier.clear()

    def detect(self, image: np.ndarray, optics: Optics, settings: MovementSettings) -> list[MovingCluster] | None:
        """What has moved, the largest first; None where there was no picture from the same place to compare with."""
        picture = _prepared(image)
        seen_from = (settings.camera, settings.pose)
        another_size = bool(self._earlier) and self._earlier[0][1].shape != picture.shape
        if another_size or not _same_place(self._seen_from, seen_from):
            self._earlier.clear()
            self._seen_from = seen_from
        before = self._reference(settings.time - MOMENT)
        self._earlier.append((settings.time, picture))
        if before is None:
            return None
        threshold = FINEST + (COARSEST - FINEST) * (1.0 - settings.sensitivity)
        moving = _changed(before, picture, threshold)
        if np.count_nonzero(moving) > EVERYTHING * moving.size:
            self._earlier.clear()
            return None
        return _clusters(moving, optics)

    def _reference(self, time: float) -> np.ndarray | None:
        """The latest picture that is as old as `time` or older; those before it are forgotten."""
        while len(self._earlier) > 1 and self._earlier[1][0] <= time + TOLERANCE:
            self._earlier.popleft()
        if self._earlier and self._earlier[0][0] <= time + TOLERANCE:
            return self._earlier[0][1]
        return None


def _prepared(image: np.ndarray) -> np.ndarray:
    """(h, w, 3) picture, smaller and without the noise of single pixels."""
    height, width = image.shape[:2]
    if width > WIDTH:
        image = cv2.resize(image, (WIDTH, round(height * WIDTH / width)), interpolation=cv2.INTER_AREA)
    return cv2.GaussianBlur(image, (5, 5), 0)


def _same_place(one: tuple[int, Sequence[float]] | None, other: tuple[int, Sequence[float]]) -> bool:
    if one is None or one[0] != other[0]:
        return False
    shifts = [abs(a - b) for a, b in zip(one[1][:3], other[1][:3])]
    turns = [abs(math.remainder(a - b, math.tau)) for a, b in zip(one[1][3:], other[1][3:])]
    return max(shifts) < STILL_SHIFT and max(turns) < STILL_ANGLE


def _changed(before: np.ndarray, now: np.ndarray, threshold: float) -> np.ndarray:
    """(h, w) mask, 255 where a pixel is outside what it and its neighbours were, by more than `threshold`.

    A change of brightness of the whole picture, as of a camera that adjusts its exposure, counts for nothing.
    """
    typical = [float(np.median(picture[::SKIPPED, ::SKIPPED])) for picture in (before, now)]
    if min(typical) > 0.0 and typical[0] != typical[1]:
        before = cv2.convertScaleAbs(before, alpha=typical[1] / typical[0])
    around = np.ones((3, 3), np.uint8)
    brighter = cv2.subtract(now, cv2.dilate(before, around))
    darker = cv2.subtract(cv2.erode(before, around), now)
    most = cv2.max(brighter, darker).max(axis=2)
    return np.where(most > threshold, np.uint8(255), np.uint8(0))


def _clusters(moving: np.ndarray, optics: Optics) -> list[MovingCluster]:
    height, width = moving.shape
    reach = max(3, round(GAP * width) | 1)
    joined = cv2.dilate(moving, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (reach, reach)))
    count, labels = cv2.connectedComponents(joined)
    found = []
    for label in range(1, count):
        rows, columns = np.nonzero((labels == label) & (moving > 0))
        if len(rows) >= LEAST_SHARE * moving.size:
            found.append((len(rows), _cluster(rows, columns, moving.shape, optics)))
    return [cluster for _, cluster in sorted(found, key=lambda pair: -pair[0])]


def _cluster(rows: np.ndarray, columns: np.ndarray, shape: Tuple[int, int], optics: Optics) -> MovingCluster:
    height, width = shape
    left, right, top, bottom = columns.min(), columns.max() + 1, rows.min(), rows.max() + 1
    alpha, beta = optics.angles((columns.mean() + 0.5) / width, (rows.mean() + 0.5) / height)
    return MovingCluster(
        alpha,
        beta,
        corner=optics.angles(left / width, top / height),
        size=optics.angular_size((right - left) / width, (bottom - top) / height),
        share_of_picture=len(rows) / (width * height),
        share_of_rectangle=len(rows) / float((right - left) * (bottom - top)),
    )
