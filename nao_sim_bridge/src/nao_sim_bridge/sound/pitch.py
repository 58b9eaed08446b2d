"""Higher or lower without getting shorter or longer: a phase vocoder, then a change of rate. Arithmetic only."""

from __future__ import annotations

import numpy as np
import soxr

LOWEST, HIGHEST = 0.25, 4.0
# Length of the windows in samples: long enough for two periods of a low note at 48 kHz.
WINDOW = 2048


def shifted(samples: np.ndarray, factor: float, rate: int, window: int = WINDOW) -> np.ndarray:
    """A (frames, channels) sound with all its frequencies times `factor`, 0.25 to 4, as long as before; float32.

    The windows are `window` samples long; voices want about 30 ms.
    """
    if factor == 1.0 or len(samples) == 0:
        return np.asarray(samples, dtype=np.float32)
    channels = np.asarray(samples, dtype=np.float64).T
    return np.stack([_shifted(channel, factor, rate, window) for channel in channels], axis=1)


def stretched(samples: np.ndarray, factor: float, window: int = WINDOW) -> np.ndarray:
    """One channel made `factor` times as long, at the same pitch; `window` as in `shifted`.

    The spectrum of each window is put together again with phases that advance as fast as between two neighbouring
    windows of the original. Peaks take the bins beside them along, which keeps voices from sounding hollow.
    """
    hop = window // 4
    padded = np.concatenate([np.zeros(window), samples, np.zeros(2 * window)])
    shape = np.hanning(window + 1)[:-1]
    count = int(np.ceil((len(samples) + window) * factor / hop)) + 1
    bins = np.arange(window // 2 + 1)
    expected = 2.0 * np.pi * hop * bins / window
    output = np.zeros(count * hop + window)
    weight = np.zeros_like(output)
    phase = np.zeros(len(bins))
    for number in range(count):
        begin = int(round(number * hop / factor))
        begin = min(begin, len(padded) - window - hop)
        now = np.fft.rfft(shape * padded[begin : begin + window])
        ahead = np.fft.rfft(shape * padded[begin + hop : begin + hop + window])
        magnitude = np.abs(now)
        place = slice(number * hop, number * hop + window)
        locked = _locked_to_peaks(phase, np.angle(now), magnitude) if number else np.angle(now)
        output[place] += shape * np.fft.irfft(magnitude * np.exp(1j * locked))
        weight[place] += shape**2
        turn = np.angle(ahead) - np.angle(now) - expected
        phase = locked + expected + turn - 2.0 * np.pi * np.round(turn / (2.0 * np.pi))
    output /= np.maximum(weight, 0.1)
    start = int(round(window * factor))
    return output[start : start + int(round(len(samples) * factor))]


def _locked_to_peaks(phase: np.ndarray, heard: np.ndarray, magnitude: np.ndarray) -> np.ndarray:
    """Phases in which the bins around a peak keep the differences to it that were heard."""
    inner = magnitude[1:-1]
    peaks = 1 + np.flatnonzero((inner > magnitude[:-2]) & (inner >= magnitude[2:]))
    if len(peaks) == 0:
        return phase
    middles = (peaks[1:] + peaks[:-1] + 1) // 2
    owner = peaks[np.searchsorted(middles, np.arange(len(magnitude)), side="right")]
    return phase[owner] + heard - heard[owner]


def _shifted(channel: np.ndarray, factor: float, rate: int, window: int) -> np.ndarray:
    long = stretched(channel, factor, window)
    # Read `factor` times as fast, it is as long as before. soxr only looks at the ratio of the two rates.
    same = soxr.resample(long, rate * factor, rate, quality="HQ")
    result = np.zeros(len(channel), dtype=np.float32)
    count = min(len(same), len(channel))
    result[:count] = same[:count]
    return result
