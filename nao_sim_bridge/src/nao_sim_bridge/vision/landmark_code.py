"""Numbers of landmarks: which mark's fans, in which rotation, are most like what is seen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterator

import numpy as np

from nao_sim_bridge.cameras.optics import Intrinsics
from nao_sim_bridge.vision.ellipse import Ellipse, sample
from nao_sim_bridge.vision.settings import LandmarkSettings
from nao_sim_bridge.world.painting.known_landmarks import Landmarks

PER_SECTOR = 8
"""Angles at which a sector is looked at; a rotation is found to a fraction of this."""
LEAST_SLANT = 0.02
"""Share of the radius; less perspective makes no difference."""


@dataclass(frozen=True, eq=False)
class Reading:
    """What a disc says.

    Attributes:
        number: Of the mark.
        heading: Its turn in the picture, rad, counterclockwise.
        quality: Correlation of its fans with those of the mark, up to 1.
        middle: (2,) place of its middle in the picture, pixels: not that of the ellipse when it is near and slanted.
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
