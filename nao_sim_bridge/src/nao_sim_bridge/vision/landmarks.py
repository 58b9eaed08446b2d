"""Reads landmarks: dark discs on a light ground, whose white fans make a number.

A disc has the number whose fans, in some rotation, are most like what is seen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Iterator

import cv2
import numpy as np

from nao_sim_bridge.cameras.optics import Intrinsics, Optics
from nao_sim_bridge.vision.ellipse import Ellipse, distance_from, ellipse_of, sample
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
PER_SECTOR = 8
"""Angles at which a sector is looked at; a rotation is found to a fraction of this."""
LEAST_SLANT = 0.02
"""Share of the radius; less perspective makes no difference."""


@dataclass(frozen=True, eq=False)
class Reading:
    """What a disc says: the number of its mark and the mark's heading, its turn in the picture, rad, counterclockwise.

    The quality is the correlation of its fans with those of the mark, up to 1. The middle, (2,) in pixels, is not that
    of the ellipse when it is near and slanted.
    """

    number: int
    heading: float
    quality: float
    middle: np.ndarray


class LandmarkCode:
    """Compares the fans of a disc with those of all marks in all rotations."""

    def __init__(self, marks: Landmarks, settings: LandmarkSettings) -> None:
        self._settings = settings
        self._marks = marks
        self._numbers = list(marks.marks)
        self._count = marks.sectors * PER_SECTOR
        self._turns = (np.arange(self._count) + 0.5) * (2.0 * math.pi / self._count)
        inner, outer = marks.fan_inner, marks.fan_outer
        self._shares = np.linspace(inner + 0.35 * (outer - inner), outer - 0.12 * (outer - inner), 6)
        patterns = np.array([np.repeat(bits, PER_SECTOR) for bits in marks.marks.values()], dtype=float)
        self._bits = np.array(list(marks.marks.values()), dtype=bool)
        # Blurred as a small mark is: sharp ones are still most like their own.
        blurred = _blurred(patterns, PER_SECTOR // 2)
        self._spectra = np.conj(np.fft.rfft(_normalised(blurred), axis=1))

    def read(self, grey: np.ndarray, ellipse: Ellipse, lens: Intrinsics) -> Reading | None:
        """The mark that a disc with this edge is in a (h, w) uint8 picture, None when it is none."""
        # Which end of a slanted disc is nearer cannot be told from its edge.
        both = [slant if np.linalg.norm(slant) >= LEAST_SLANT else None for slant in ellipse.slants(lens)]
        readings = [reading for side in both for reading in self._read(grey, ellipse, side)]
        return max(readings, key=lambda reading: reading.quality, default=None)

    def _read(self, grey: np.ndarray, ellipse: Ellipse, slant: np.ndarray | None) -> Iterator[Reading]:
        """The mark that a disc is when perspective moves its middle to `slant`, if it is one."""
        values = sample(grey, ellipse.points(self._turns, self._shares, slant))
        rim = sample(grey, ellipse.points(self._turns[::4], np.array((0.88, 0.92))))
        card = sample(grey, ellipse.points(self._turns[::4], np.array((1.1, 1.16))))
        profile = values.mean(axis=1)
        white, black = np.percentile(profile, 90), np.percentile(profile, 10)
        if white - black < self._settings.contrast or not self._framed(rim, card, black, white):
            return
        likeness = np.fft.irfft(np.fft.rfft(_normalised(profile)) * self._spectra, n=self._count, axis=1)
        best = likeness.max(axis=1)
        which = int(np.argmax(best))
        others = np.delete(best, which)
        if best[which] < self._settings.likeness or best[which] - others.max() < self._settings.lead:
            return
        turn = _peak(likeness[which])
        if not self._all_right(profile, which, turn):
            return
        heading = -turn * 2.0 * math.pi / self._count
        middle = ellipse.center if slant is None else ellipse.center + ellipse.shape @ slant
        yield Reading(self._numbers[which], math.remainder(heading, 2.0 * math.pi), float(best[which]), middle)

    def _framed(self, rim: np.ndarray, card: np.ndarray, black: float, white: float) -> bool:
        """Whether there is a dark rim around the fans, and a light card around that."""
        middle = (black + white) / 2.0
        return float(np.mean(rim)) < middle and float(np.mean(card.max(axis=1) > middle)) >= self._settings.rim

    def _all_right(self, profile: np.ndarray, which: int, turn: float) -> bool:
        """Whether every single sector is what it should be: one that is not makes a mark doubtful."""
        middles = (np.arange(self._marks.sectors) + 0.5) * PER_SECTOR - 0.5 + turn
        read = np.interp(middles, np.arange(-self._count, 2 * self._count), np.tile(profile, 3))
        bits = self._bits[which]
        white, black = read[bits], read[~bits]
        return float(white.min()) > float(black.max())


def _blurred(patterns: np.ndarray, half: int) -> np.ndarray:
    """Running means over 2 * half + 1 angles of (n, m) patterns that go all the way round."""
    padded = np.concatenate([patterns[:, -half:], patterns, patterns[:, :half]], axis=1)
    kernel = np.ones(2 * half + 1) / (2 * half + 1)
    return np.array([np.convolve(row, kernel, mode="valid") for row in padded])


def _normalised(rows: np.ndarray) -> np.ndarray:
    """Rows with mean 0 and length 1."""
    centred = rows - rows.mean(axis=-1, keepdims=True)
    return centred / np.maximum(np.linalg.norm(centred, axis=-1, keepdims=True), 1e-9)


def _peak(values: np.ndarray) -> float:
    """Place of the maximum of values that go all the way round, between the samples."""
    top = int(np.argmax(values))
    before, here, after = values[top - 1], values[top], values[(top + 1) % len(values)]
    bend = before - 2.0 * here + after
    return top + (0.5 * (before - after) / bend if bend < 0.0 else 0.0)


@dataclass(frozen=True)
class Landmark:
    """A landmark in a picture; its quality says how much its fans look like those of the number, up to 1.

    Angles are in rad. The direction of its middle is alpha, seen from above, to the left, and beta, seen from the side,
    downwards. Width and height are the angles that it fills; the size is the one that its disc would fill seen from the
    front, by the longest diameter. The heading is its turn in the picture, counterclockwise. Its middle is at x, 0 at
    the left edge of the picture to 1 at the right one, and y, likewise from the upper edge down.
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
    pixels = np.array(shape[1::-1])
    x, y = (reading.middle / pixels).tolist()
    alpha, beta = optics.angles(x, y)
    left, top = optics.angles(*(ellipse.center - ellipse.half_extent) / pixels)
    right, bottom = optics.angles(*(ellipse.center + ellipse.half_extent) / pixels)
    turn, size = reading.heading, _size(ellipse, optics, shape)
    return Landmark(reading.number, alpha, beta, left - right, bottom - top, turn, size, x, y, reading.quality)
