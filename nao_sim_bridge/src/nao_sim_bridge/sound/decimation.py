"""From 48 kHz to 16 kHz: a filter without delay, and every third sample."""

from __future__ import annotations

import numpy as np

REACH = 48
"""Frames before and after a place that the filter looks at."""
THIRD_RATE = 16000


def _low_pass() -> np.ndarray:
    """Passes up to 7 kHz within 0.1 dB, and what would be folded down from above 9 kHz not at all (-80 dB)."""
    at = np.arange(-REACH, REACH + 1)
    taps = np.sinc(at / 3.0) * np.kaiser(2 * REACH + 1, 8.0)
    return (taps / taps.sum()).astype(np.float32)


LOW_PASS = _low_pass()


def third(signal: np.ndarray) -> np.ndarray:
    """Every third sample of a signal, free of what the lower rate cannot hold.

    Args:
        signal: (REACH + 3 n + REACH,) float32; the first sample of the result is that at REACH.

    Returns:
        (n,) float32.
    """
    # Three filters for the three phases, each at the lower rate: a third of the work.
    count = (len(signal) - 2 * REACH) // 3
    out = np.zeros(count, np.float32)
    for phase in range(3):
        taps = LOW_PASS[phase::3]
        out += np.convolve(signal[phase::3][: count + len(taps) - 1], taps[::-1], "valid")
    return out
