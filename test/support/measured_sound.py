"""How loud and how high a sound is."""

from __future__ import annotations

import numpy as np

RATE = 48000


def loudness(samples):
    return np.sqrt(np.mean(np.asarray(samples, dtype=float) ** 2))


def frequency(samples, rate=RATE):
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    return np.argmax(spectrum) * rate / len(samples)
