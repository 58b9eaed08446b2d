"""Recognises pictures and sides of things that were learnt, by key points: whatever their size, turn and tilt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence, Tuple

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Optics

WIDTH = 320
"""A picture is learnt in this width at most, px: more is not seen of it by the cameras."""
SCALES = (1.0, 0.5, 0.25)
"""It is learnt in these sizes, as it is seen from near and from far: what is small is not found again from far."""
MOST_POINTS = 200
"""Key points that are kept of each size, those that stand out most."""
LEAST_POINTS = 12
"""With fewer a picture cannot be learnt: it has no texture."""
DISTINCT = 0.75
"""A key point is found again where it fits this much better than anywhere else."""
LEAST_FOUND = 8
"""So many key points have to be found again, all in one plane."""
OFF_PLANE = 4.0
"""How far a key point may be from where the plane has it, px."""
LEAST_AREA = 300.0
"""Of a picture in the view, px: a smaller one is a chance find."""
BACKGROUND = 40.0
"""A pixel that differs more from the edge of the picture, of 255, is of the thing and not of the background."""

Angles = Tuple[float, float]


@dataclass(frozen=True, eq=False)
class LearntPicture:
    """What is kept of a picture: (n, 2) float32 key points and (m, 2) float32 corners of its outline, px.

    The (n, 128) uint8 descriptions are those of the key points.
    """

    points: np.ndarray
    descriptions: np.ndarray
    outline: np.ndarray


@dataclass(frozen=True)
class SeenPicture:
    """A picture that is recognised: which one of those that are known, and how many key points are found again.

    `share` is that of its key points; the corners of its outline are directions: to the left and downwards, rad.
    """

    number: int
    found: int
    share: float
    outline: Tuple[Angles, ...]


class PictureDetector:
    """Finds those of the known pictures that are in view."""

    def __init__(self, known: Sequence[LearntPicture] = ()) -> None:
        self._known = [(one, one.descriptions.astype(np.float32)) for one in known]
        self._sift = cv2.SIFT_create(nfeatures=2 * MOST_POINTS)
        self._matcher = cv2.BFMatcher(cv2.NORM_L2)

    def learn(self, image: np.ndarray, whole: bool) -> LearntPicture | None:
        """Key points of a (h, w, 3) uint8 picture in blue, green, red; None when there are too few.

        Args:
            image: The picture.
            whole: Whether all of it counts, or only what stands out from the one colour of its edge.
        """
        scale = WIDTH / max(image.shape[1], WIDTH)
        small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) if scale < 1.0 else image
        height, width = small.shape[:2]
        outline = np.array([(0, 0), (width, 0), (width, height), (0, height)], np.float32)
        mask = None
        if not whole:
            found = _outline(small)
            if found is None:
                return None
            outline, mask = found
        found_in = [self._described(*_scaled(small, mask, scale)) for scale in SCALES]
        points = np.concatenate([one[:MOST_POINTS] / scale for (one, _), scale in zip(found_in, SCALES)])
        if len(points) < LEAST_POINTS:
            return None
        descriptions = np.concatenate([one[:MOST_POINTS] for _, one in found_in]).astype(np.uint8)
        return LearntPicture(points.astype(np.float32), descriptions, outline)

    def detect(self, image: np.ndarray, optics: Optics, most: int) -> list[SeenPicture]:
        """The known pictures in view, at most so many, those with most key points first; see `Detector`."""
        if not self._known:
            return []
        points, descriptions = self._described(image, None)
        if len(points) < LEAST_FOUND:
            return []
        size = np.array(image.shape[1::-1], float)
        seen = [self._find(number, points, descriptions, size, optics) for number in range(len(self._known))]
        return sorted(filter(None, seen), key=lambda one: -one.found)[:most]

    def _described(self, image: np.ndarray, mask: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        """(n, 2) key points and (n, 128) descriptions, strongest first."""
        key_points, descriptions = self._sift.detectAndCompute(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), mask)
        if not key_points:
            return np.empty((0, 2), np.float32), np.empty((0, 128), np.float32)
        order = np.argsort([-point.response for point in key_points], kind="stable")
        return np.array([key_points[i].pt for i in order], np.float32), descriptions[order]

    def _find(
        self, number: int, points: np.ndarray, descriptions: np.ndarray, size: np.ndarray, optics: Optics
    ) -> SeenPicture | None:
        known, wanted = self._known[number]
        pairs = (pair for pair in self._matcher.knnMatch(wanted, descriptions, k=2) if len(pair) == 2)
        good = [first for first, second in pairs if first.distance < DISTINCT * second.distance]
        if len(good) < LEAST_FOUND:
            return None
        there = points[[match.trainIdx for match in good]]
        plane, fits = cv2.findHomography(known.points[[m.queryIdx for m in good]], there, cv2.RANSAC, OFF_PLANE)
        if plane is None:
            return None
        found = len({match.trainIdx for match, fit in zip(good, fits.ravel()) if fit})
        corners = cv2.perspectiveTransform(known.outline[None], plane)[0]
        if found < LEAST_FOUND or not _plausible(corners):
            return None
        outline = tuple(optics.angles(*(corner / size)) for corner in corners.astype(float))
        return SeenPicture(number, found, found / len(known.points), outline)


def _scaled(image: np.ndarray, mask: np.ndarray | None, scale: float) -> tuple[np.ndarray, np.ndarray | None]:
    """A picture and its mask in another size."""
    if scale == 1.0:
        return image, mask
    smaller = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    if mask is not None:
        mask = cv2.resize(mask, smaller.shape[1::-1], interpolation=cv2.INTER_NEAREST)
    return smaller, mask


def _plausible(corners: np.ndarray) -> bool:
    """Whether an outline can be that of something flat seen from its front."""
    hull = cv2.convexHull(corners)
    return bool(np.all(np.isfinite(corners))) and cv2.contourArea(hull) > LEAST_AREA


def _outline(image: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Corners of what stands out from the colour of the edge, and its (h, w) mask; None when nothing does."""
    edge = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
    off = np.abs(image.astype(np.int16) - np.median(edge, axis=0)).max(axis=2)
    contours, _ = cv2.findContours((off > BACKGROUND).astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    if not contours:
        return None
    corners = cv2.boxPoints(cv2.minAreaRect(max(contours, key=cv2.contourArea)))
    if cv2.contourArea(corners) < LEAST_AREA:
        return None
    mask = np.zeros(image.shape[:2], np.uint8)
    cv2.fillConvexPoly(mask, corners.astype(np.int32), 255)
    return corners.astype(np.float32), mask
