"""Reads landmarks: dark discs on a light ground, whose white fans make a number."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Iterator

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.vision.ellipse import Ellipse, distance_from, ellipse_of, sample
from nao_sim_bridge.vision.landmark_code import LandmarkCode, Reading
from nao_sim_bridge.vision.settings import LandmarkSettings, load_vision
from nao_sim_bridge.world.painting.known_landmarks import Landmarks, load_landmarks

ROUNDS = 2
"""How often edges are looked for, each time around a better ellipse."""
RAYS = 48
"""On which edges are looked for."""
LEAST_DARK = 0.2
"""Share of its box that is dark, at least: rim and hub of a slanted mark with many fans."""
SHARES = np.linspace(0.82, 1.22, 21)
"""Where along the rays, as shares of the radius: from the black rim to the white card."""
NEEDED = SHARES <= 1.1
"""How much of the card has to be in the picture."""


@dataclass(frozen=True)
class Landmark:
    """A landmark in a picture.

    Attributes:
        alpha: Direction of its middle seen from above, rad, positive to the left.
        beta: Direction of its middle seen from the side, rad, positive downwards.
        width: Angle from its left to its right end, rad.
        height: Angle from its upper to its lower end, rad.
        heading: By how much it is turned in the picture, rad, counterclockwise as one sees it.
        size: Angle that its disc would fill seen from the front, rad: from the longest diameter.
        x: Its middle in the picture, 0 at the left edge and 1 at the right one.
        y: The same from the upper edge to the lower one.
        quality: How much its fans look like those of the number, up to 1.
    """

    number: int
    alpha: float
    beta: float
    width: float
    height: float
    heading: float
    size: float
    x: float
    y: float
    quality: float


class LandmarkDetector:
    """All landmarks in a picture, from left to right."""

    def __init__(self, marks: Landmarks | None = None, settings: LandmarkSettings | None = None) -> None:
        self._settings = settings or load_vision().landmarks
        self._code = LandmarkCode(marks or load_landmarks(), self._settings)

    def detect(self, image: np.ndarray, optics: Optics, _: Any = None) -> list[Landmark]:
        """The landmarks in a picture; see `Detector`."""
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        lens = optics.intrinsics(grey.shape[1], grey.shape[0])
        found: list[tuple[Ellipse, Landmark]] = []
        tried: list[Ellipse] = []
        for guess in _discs(grey, self._settings):
            if _among(guess, tried):
                continue
            ellipse = self._refined(guess, grey)
            if ellipse is None:
                continue
            tried.append(guess)
            reading = self._code.read(grey, ellipse, lens)
            if reading is not None and not _among(ellipse, [other for other, _ in found]):
                found.append((ellipse, _landmark(reading, ellipse, optics, grey.shape)))
        return sorted((mark for _, mark in found), key=lambda mark: mark.x)

    def _refined(self, ellipse: Ellipse, grey: np.ndarray) -> Ellipse | None:
        """The ellipse at the edge between the black rim and the card; None where there is no such edge."""
        turns = np.arange(RAYS) * (2.0 * math.pi / RAYS)
        for _ in range(ROUNDS):
            places = ellipse.points(turns, SHARES)
            high = np.array(grey.shape[::-1]) - 1.0
            if np.any(places[:, NEEDED] < 0.5) or np.any(places[:, NEEDED] > high + 0.5):
                return None  # not wholly in the picture
            values = sample(grey, places)
            dark, light = values[:, :8].min(axis=1), values[:, -8:].max(axis=1)
            if np.mean(light - dark >= self._settings.contrast) < self._settings.rim:
                return None
            half = (np.median(dark) + np.median(light)) / 2.0
            # Where it turns from dark to light, as near as can be: fans end inside, and the card may end outside.
            rises = (values[:, :-1] < half) & (values[:, 1:] >= half)
            has = rises.any(axis=1)
            if has.mean() < self._settings.rim:
                return None
            rows = np.flatnonzero(has)
            index = np.argmin(np.where(rises, np.abs(SHARES[1:] - 1.0), np.inf), axis=1)[rows] + 1
            before, after = values[rows, index - 1], values[rows, index]
            part = (half - before) / np.maximum(after - before, 1e-6)
            edges = places[rows, index - 1] + part[:, None] * (places[rows, index] - places[rows, index - 1])
            better = ellipse_of(edges.astype(np.float32))
            if better is None or not _likely(better, self._settings):
                return None
            off = distance_from(better, edges)
            ellipse = better
            allowed = self._settings.roundness[0] + self._settings.roundness[1] * better.radii[0]
            if np.sqrt(np.mean(off**2)) > allowed:
                return None
        return ellipse


# --- inside ---------------------------------------------------------------------------------------------------------


def _discs(grey: np.ndarray, settings: LandmarkSettings) -> Iterator[Ellipse]:
    """Dark areas with the outline of an ellipse, at several levels of what is dark: light need not be even."""
    coarse = cv2.resize(grey, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)  # a small mark is a few pixels here
    low, high = float(coarse.min()), float(coarse.max())
    for share in np.linspace(settings.levels[0], settings.levels[1], int(settings.levels[2])):
        level = low + share * (high - low)
        dark = (grey < level).astype(np.uint8)
        _, labels, boxes, _ = cv2.connectedComponentsWithStats(dark, connectivity=4)
        for label in _round_enough(boxes, grey.shape, settings):
            left, top, width, height = boxes[label, :4]
            # A border all around, for the outline is that of the outermost pixels.
            area = np.pad((labels[top : top + height, left : left + width] == label).astype(np.uint8), 1)
            contours, _ = cv2.findContours(area, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
            outline = max(contours, key=len)[:, 0, :] + (left - 0.5, top - 0.5)
            ellipse = ellipse_of(outline.astype(np.float32))
            if ellipse is None or not _likely(ellipse, settings):
                continue
            if np.mean(np.abs(distance_from(ellipse, outline))) <= 0.45 + 0.06 * ellipse.radii[1]:
                # The outline goes through the middles of the outermost dark pixels.
                yield Ellipse(ellipse.center, ellipse.shape * (1.0 + 0.5 / ellipse.radii[0]))


def _round_enough(boxes: np.ndarray, shape: tuple[int, ...], settings: LandmarkSettings) -> np.ndarray:
    """Which components, by their boxes and areas, may be discs wholly in the picture; the first is the background."""
    left, top, width, height, area = boxes.T
    inside = (left > 0) & (top > 0) & (left + width < shape[1]) & (top + height < shape[0])
    long, short = np.maximum(width, height), np.minimum(width, height)
    possible = inside & (long >= settings.least_diameter - 2.0) & (short >= settings.least_ratio * long - 2.0)
    possible &= area >= LEAST_DARK * width * height
    possible[0] = False
    return np.flatnonzero(possible)


def _likely(ellipse: Ellipse, settings: LandmarkSettings) -> bool:
    long, short = ellipse.radii
    return 2.0 * long >= settings.least_diameter and short >= settings.least_ratio * long


def _among(ellipse: Ellipse, others: list[Ellipse]) -> bool:
    """Whether one of the others is in the same place and as large."""
    radius = ellipse.radii[1]
    for other in others:
        if np.linalg.norm(ellipse.center - other.center) < 0.15 * radius + 0.3:
            if abs(other.radii[1] - radius) < 0.12 * radius + 0.3:
                return True
    return False


def _size(ellipse: Ellipse, optics: Optics, shape: tuple[int, ...]) -> float:
    """The widest angle between two opposite points of the edge, rad."""
    height, width = shape[:2]
    lens = optics.intrinsics(width, height)
    edge = ellipse.points(np.arange(RAYS) * (2.0 * math.pi / RAYS), np.ones(1))[:, 0]
    rays = np.column_stack([np.ones(RAYS), (edge - (lens.cx, lens.cy)) / (lens.fx, lens.fy)])
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    cosines = np.sum(rays[: RAYS // 2] * rays[RAYS // 2 :], axis=1)
    return float(np.arccos(np.clip(cosines.min(), -1.0, 1.0)))


def _landmark(reading: Reading, ellipse: Ellipse, optics: Optics, shape: tuple[int, ...]) -> Landmark:
    height, width = shape[:2]
    (column, row), (middle, level), (across, down) = reading.middle, ellipse.center, ellipse.half_extent
    x, y = float(column) / width, float(row) / height
    alpha, beta = optics.angles(x, y)
    left, _ = optics.angles((middle - across) / width, y)
    right, _ = optics.angles((middle + across) / width, y)
    _, top = optics.angles(x, (level - down) / height)
    _, bottom = optics.angles(x, (level + down) / height)
    return Landmark(
        number=reading.number,
        alpha=alpha,
        beta=beta,
        width=left - right,
        height=bottom - top,
        heading=reading.heading,
        size=_size(ellipse, optics, shape),
        x=x,
        y=y,
        quality=reading.quality,
    )
