"""When a sound begins and ends: what stands out from the background, to which the ear gets used.

The power of each band of frequencies is compared with its floor. A floor follows downwards at once and upwards slowly,
so a steady noise becomes background after some seconds, and the pauses of speech keep the floor below it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.hearing.spectra import FRAME, HOP, LOWEST, band, frequencies, short_spectra

BANDS_PER_OCTAVE = 2.0
# How fast a floor rises, dB/s, and which share of a fall it follows in a frame.
RISE, FALL = 3.0, 0.1
SMOOTHING = 0.25
# No floor is below this, mean square of all bands: there, rounding to whole numbers makes what is heard.
LEAST_FLOOR = 1.0
# Frames that the first floor is the mean of.
FIRST = 4
# How far the mean of all bands must stand out at sensitivity 1 and 0, dB, and by how much less at the end of a sound.
MOST_SENSITIVE, LEAST_SENSITIVE = 4.0, 30.0
HYSTERESIS = 3.0
# A sound is over when it has been quiet for this long, s: words belong together.
PAUSE = 0.25
DEFAULT_SENSITIVITY = 0.9
START, END = 1, 0


@dataclass(frozen=True)
class Edge:
    """Beginning or end of a sound, by its kind, `START` or `END`, at a simulated time, s; confidence 0..1.

    Its index is the sample of the block at which it is, 0 when it was before the block.
    """

    kind: int
    index: int
    time: float
    confidence: float


class SoundDetector:
    """Follows the sound of the microphones, block by block.

    The `rate` is theirs in Hz. At a higher sensitivity, 0..1, a sound may be softer. `floor` is the power of a
    background, in samples squared over all bands, that is taken for granted at the start; None takes what is heard
    first for background. Of the last block there are the spectra, (frames, bins, microphones), and whether something
    stood out: `loud`.
    """

    def __init__(self, rate: int, floor: float | None = None) -> None:
        self.sensitivity = DEFAULT_SENSITIVITY
        self.spectra = np.zeros((0, 0, 0), complex)
        self.loud = False
        self._rate = rate
        self._starts = _band_starts(rate)
        shares = np.diff(np.append(self._starts, len(frequencies(rate)))) / (FRAME / 2.0)
        self._least = LEAST_FLOOR * shares
        self._floor = None if floor is None else floor * shares
        self._smooth: np.ndarray | None = None
        self._rest = np.zeros((0, 0))
        self._sounding = False
        self._last_loud = 0.0

    @property
    def background(self) -> np.ndarray:
        """(bins,) power of the background at each frequency, as far as it is known."""
        widths = np.diff(np.append(self._starts, len(frequencies(self._rate))))
        floor = self._least if self._floor is None else np.maximum(self._floor, self._least)
        return np.repeat(floor / widths, widths)

    def feed(self, samples: np.ndarray, time: float) -> list[Edge]:
        """Listen to a block, (n, microphones) int16 from `time`, s, on; the beginnings and ends of sounds in it."""
        rest = self._rest if self._rest.shape[1:] == samples.shape[1:] else samples[:0]
        joined = np.concatenate([rest, samples])
        first = -len(rest)
        self.loud = False
        if len(joined) < FRAME:
            self._rest = joined
            return []
        self.spectra = short_spectra(joined, self._rate)
        self._rest = joined[len(self.spectra) * HOP :]
        powers = np.add.reduceat((np.abs(self.spectra) ** 2).mean(axis=2), self._starts, axis=1)
        new = first + FRAME - HOP  # what is new in a frame is its second half
        edges = [self._follow(excess, new + number * HOP, time) for number, excess in enumerate(self._excesses(powers))]
        return [edge for edge in edges if edge is not None]

    def _excesses(self, powers: np.ndarray) -> list[float]:
        """By how much each frame stands out, dB; moves the floors along."""
        rise = 10.0 ** (0.1 * RISE * HOP / self._rate)
        if self._floor is None:
            self._floor = powers[:FIRST].mean(axis=0)
        if self._smooth is None:
            self._smooth = powers[0]
        excesses = []
        for power in powers:
            floor = np.maximum(self._floor, self._least)
            excesses.append(10.0 * math.log10(float((power / floor).mean()) + 1e-9))
            self._smooth = self._smooth + SMOOTHING * (power - self._smooth)
            lower = self._smooth < floor
            self._floor = np.where(lower, floor + FALL * (self._smooth - floor), np.minimum(floor * rise, self._smooth))
        return excesses

    def _follow(self, excess: float, index: int, block_time: float) -> Edge | None:
        threshold = LEAST_SENSITIVE + (MOST_SENSITIVE - LEAST_SENSITIVE) * self.sensitivity
        time = block_time + index / self._rate
        if excess >= threshold - (HYSTERESIS if self._sounding else 0.0):
            self.loud = True
            self._last_loud = time + HOP / self._rate
            if self._sounding:
                return None
            self._sounding = True
            return Edge(START, max(index, 0), time, _confidence(excess - threshold))
        if self._sounding and time >= self._last_loud + PAUSE:
            self._sounding = False
            index = round((self._last_loud - block_time) * self._rate)
            return Edge(END, max(index, 0), self._last_loud, _confidence(threshold - excess))
        return None


def _confidence(margin: float) -> float:
    """0.5 at the threshold, towards 1 with the margin in dB beyond it."""
    return 1.0 - 0.5 * 10.0 ** (-max(margin, 0.0) / 10.0)


def _band_starts(rate: int) -> np.ndarray:
    """First bin of each band, counted from the first that is looked at."""
    bins = frequencies(rate)
    edges = LOWEST * 2.0 ** (np.arange(1, 64) / BANDS_PER_OCTAVE)
    starts = np.searchsorted(bins, edges[edges < bins[-1]])
    # A band of less than two bins would only say what its neighbours do, less surely.
    kept = [0]
    for start in starts:
        if start - kept[-1] >= 2 and band(rate).stop - band(rate).start - start >= 2:
            kept.append(int(start))
    return np.array(kept)
