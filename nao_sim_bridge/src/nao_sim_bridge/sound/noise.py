"""Background noise: white, and a pure function of seed and frame number."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

CHUNK = 16384
SUPPLY = 2**18
"""Frames that noise is cut from: drawing new ones all the time would be most of the work of hearing."""


class Background:
    """Noise of several channels, independent of each other.

    Each chunk is cut from the supply at a place of its own, so that nothing comes again at regular times.
    """

    def __init__(self, seed: int, rms: float, channels: int = 4) -> None:
        self._seed = abs(seed)
        self._rms = np.float32(rms)
        self._channels = channels
        self._supply: np.ndarray | None = None
        self._cut = lru_cache(maxsize=64)(self._draw_cut)

    def between(self, first: int, last: int) -> np.ndarray:
        """(channels, last - first) float32 from frame `first` to `last`."""
        if self._supply is None:
            chance = np.random.Generator(np.random.SFC64([self._seed]))
            self._supply = self._rms * chance.standard_normal((self._channels, SUPPLY), np.float32)
        out = np.empty((self._channels, last - first), np.float32)
        at = first
        while at < last:
            number, offset = divmod(at, CHUNK)
            count = min(CHUNK - offset, last - at)
            cut = self._cut(number) + offset
            out[:, at - first : at - first + count] = self._supply[:, cut : cut + count]
            at += count
        return out

    def _draw_cut(self, number: int) -> int:
        """Where in the supply a chunk is cut out."""
        # A generator of its own, so that no chunk depends on which others were asked for before.
        chance = np.random.Generator(np.random.SFC64([self._seed, abs(number), int(number < 0)]))
        return int(chance.integers(SUPPLY - CHUNK))
