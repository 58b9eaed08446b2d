"""The way of sound through the air: delays of fractions of a frame, and what distance takes away. Pure functions.

A signal is first taken to twice its rate with a long filter; between those samples a cubic is good enough: a sine of
8 kHz is right within 0.02 dB, one of 16 kHz within 0.3 dB.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np

HALF = 20
"""Samples on each side that the filter to the double rate looks at."""
FIXED_HALF = 12
"""The same of the filters for fixed ways, which need not leave anything to a second step."""
ROUNDS, ENOUGH = 8, 1e-3
"""For moving sources: how often, at most, the way is worked out again, and the error in frames that is good enough."""
MARGIN = HALF + 2
"""Samples that are needed before the first and after the last place that is asked for."""


def _half_way() -> np.ndarray:
    """Filter whose output lies half-way between two samples."""
    at = np.arange(-HALF + 0.5, HALF)
    taps = np.sinc(at) * np.kaiser(2 * HALF + 2, 7.0)[1:-1]
    return (taps / taps.sum()).astype(np.float32)


HALF_WAY = _half_way()


def doubled(signal: np.ndarray) -> np.ndarray:
    """The signal, (n,) float32, at twice its rate, (2 n - 4 HALF + 2,).

    The first sample is `signal[HALF - 1]`, the next is half-way to the following one.
    """
    out = np.empty(2 * (len(signal) - 2 * HALF + 1), np.float32)
    out[0::2] = signal[HALF - 1 : len(signal) - HALF]
    out[1::2] = np.convolve(signal, HALF_WAY, "valid")
    return out


def cubic(fraction: np.ndarray | float) -> tuple:
    """Weights of the four samples around a place `fraction` (0..1) after the second of them."""
    f = fraction
    below, above, beyond = f + 1, f - 1, f - 2
    inner, outer = above * beyond, f * below
    return f * inner * (-1.0 / 6.0), below * inner * 0.5, outer * beyond * -0.5, outer * above * (1.0 / 6.0)


def at_places(read: Callable[[int, int], np.ndarray | None], places: np.ndarray) -> np.ndarray | None:
    """A signal at any places between its samples: (...) float32 for (...) float64 places; None when all is silence.

    `read` gives the (last - first,) samples of the signal from `first` to `last`, or None for silence.
    """
    first = int(np.floor(places.min())) - MARGIN
    signal = read(first, int(np.ceil(places.max())) + MARGIN + 1)
    if signal is None:
        return None
    double = doubled(signal)
    # In samples of the double rate, from the one before the first of the four.
    exact = (places - (first + HALF - 1)) * 2.0 - 1.0
    index = exact.astype(np.int32)
    weights = cubic((exact - index).astype(np.float32))
    out = np.take(double, index)
    out *= weights[0]
    for step in range(1, 4):
        index += 1
        part = np.take(double, index)
        part *= weights[step]
        out += part
    return out


@dataclass(frozen=True)
class FixedWays:
    """Ways of sound that never change, as filters, (..., n) taps.

    The first tap is for the sample `earliest` frames ago, negative when that is still to come.
    """

    earliest: int
    taps: np.ndarray

    @classmethod
    def of(cls, delays: np.ndarray, gains: np.ndarray) -> FixedWays:
        """Filters for delays in frames and gains, both (...)."""
        earliest = int(np.floor(delays.min())) - FIXED_HALF
        at = np.arange(earliest, int(np.ceil(delays.max())) + FIXED_HALF + 1) - delays[..., None]
        shares = np.clip(np.abs(at) / (FIXED_HALF + 1), 0.0, 1.0)
        taps = np.sinc(at) * np.i0(7.0 * np.sqrt(1.0 - shares**2))
        taps *= (gains / taps.sum(axis=-1))[..., None]
        return cls(earliest, taps.astype(np.float32))

    @property
    def span(self) -> tuple[int, int]:
        """How many samples before the first, and after the last frame asked for, they need."""
        return self.earliest + self.taps.shape[-1] - 1, max(0, -self.earliest)

    def through(self, signal: np.ndarray, which: tuple | int) -> np.ndarray:
        """A signal, float32 for each frame, that has come the way `which` in `taps`; of several the sum arrives.

        It is taken from `span[0]` samples before the first frame to `span[1]` after the last one.
        """
        taps = self.taps[which]
        if taps.ndim > 1:
            taps = taps.sum(axis=0)
        return np.convolve(signal, taps, "valid")


def between_knots(values: np.ndarray, step: int, skip: int, count: int, kind: type = np.float64) -> np.ndarray:
    """(k, count) frames of k straight lines between (n, k) values `step` frames apart, from `skip` after the first."""
    shares = (np.arange(step) / step).astype(kind)
    lines = values.T.astype(kind)
    whole = np.diff(lines)[:, :, None] * shares
    whole += lines[:, :-1, None]
    return whole.reshape(len(lines), -1)[:, skip : skip + count]


def arrivals(
    microphones: np.ndarray, frames: np.ndarray, places: Callable[[np.ndarray], np.ndarray], frames_per_meter: float
) -> tuple[np.ndarray, np.ndarray]:
    """When a source gave off what microphones hear at certain frames.

    Args:
        microphones: (n, k, 3) places of k microphones at n times, in world, m.
        frames: (n,) those times, in frames.
        places: Frames of any shape to places of the source there (..., 3), in world, m.
        frames_per_meter: How long sound takes, in frames.

    Returns:
        (n, k) frames at which it was given off, and (n, k) distances in m.
    """
    arrived = frames[:, None].astype(float)
    given_off = np.repeat(arrived, microphones.shape[1], axis=1)
    # Each round makes the error smaller by the ratio of the source's speed to that of sound.
    for _ in range(ROUNDS):
        distances = np.linalg.norm(places(given_off) - microphones, axis=-1)
        before, given_off = given_off, arrived - distances * frames_per_meter
        if np.abs(given_off - before).max() < ENOUGH:
            break
    return given_off, distances
