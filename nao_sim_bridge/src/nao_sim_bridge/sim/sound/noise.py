"""Background noise: white, and a pure function of seed and frame number."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

CHUNK = 4096
SUPPLY = 2**20
"""Samples that noise is cut from: drawing new ones all the time would be most of the work of hearing."""


class Background:
    """Noise of several channels, independent of each other.

    Each chunk of a channel is cut from the supply at a place of its own, so that nothing comes again at regular times.

    Args:
        seed: Of the noise.
        rms: Its size.
        channels: How many.
    """

    def __init__(self, seed: int, rms: float, channels: int = 4) -> None:
        self._seed = abs(seed)
        self._rms = np.float32(rms)
        self._channels = channels
        self._supply: np.ndarray | None = None
        self._cuts = lru_cache(maxsize=64)(self._draw_cuts)

    def between(self, first: int, last: int) -> np.ndarray:
        """(channels, last - first) float32 from frame `first` to `last`."""
        if self._supply is None:
            chance = np.random.Generator(np.random.SFC64([self._seed]))
            self._supply = self._rms * chance.standard_normal(SUPPLY, np.float32)
        out = np.empty((self._channels, last - first), np.float32)
        at = first
        while at < last:
            number, offset = divmod(at, CHUNK)
            count = min(CHUNK - offset, last - at)
            for channel, cut in enumerate(self._cuts(number)):
                out[channel, at - first : at - first + count] = self._supply[cut + offset : cut + offset + count]
            at += count
        return out

    def _draw_cuts(self, number: int) -> tuple[int, ...]:
        """Where in the supply a chunk is cut out, for each channel; no two cuts of a chunk share a sample."""
        # A generator of its own, so that no chunk depends on which others were asked for before.
        chance = np.random.Generator(np.random.SFC64([self._seed, abs(number), int(number < 0)]))
        shift = int(chance.integers(CHUNK))
        places = chance.choice(SUPPLY // CHUNK - 1, self._channels, replace=False)
        return tuple(int(place) * CHUNK + shift for place in places)
