"""Spectra of what the microphones hear, in short frames. Pure functions on arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

FRAME = 1024
HOP = 512
# Below, waves are long against the head and noise is strongest; above, speech has little left. Hz.
LOWEST, HIGHEST = 150.0, 9000.0
WINDOW = np.hanning(FRAME)
QUANTUM = 1.0 / 12.0
"""Power of the rounding to whole numbers, in units of a sample squared."""


def short_spectra(samples: np.ndarray, rate: int) -> np.ndarray:
    """(frames, bins, microphones) spectra of overlapping frames of (n, microphones) samples; only bins of `band(rate)`.

    They are scaled so that the squares over all bins of a frame add up to its mean square. There is at least one frame;
    what does not fill one at the end is left out.
    """
    frames = np.lib.stride_tricks.sliding_window_view(samples, FRAME, axis=0)[::HOP]  # frames, microphones, FRAME
    scale = np.sqrt(2.0 / FRAME / (WINDOW @ WINDOW))
    spectra = np.fft.rfft(frames * WINDOW, axis=2)[:, :, band(rate)] * scale
    return spectra.transpose(0, 2, 1)


def frames_of(samples: np.ndarray, length: int, step: int) -> np.ndarray:
    """(frames, length) overlapping pieces of (n,) samples, one each `step`; at least one, filled up with silence."""
    padded = np.pad(samples, (0, max(length - len(samples), 0)))
    return np.lib.stride_tricks.sliding_window_view(padded, length)[::step]


def band(rate: int) -> slice:
    """The bins that are looked at."""
    width = rate / FRAME
    return slice(int(np.ceil(LOWEST / width)), int(HIGHEST / width) + 1)


def frequencies(rate: int) -> np.ndarray:
    """Of the bins of `band(rate)`, Hz."""
    return np.fft.rfftfreq(FRAME, 1.0 / rate)[band(rate)]


@dataclass(frozen=True)
class CrossSpectra:
    """What microphones have in common over a block: (bins, microphones, microphones) means of x_i conj(x_j).

    The noise, (bins,), is the power at each microphone that the others do not share.
    """

    products: np.ndarray
    noise: np.ndarray

    @property
    def power(self) -> np.ndarray:
        """(bins,) mean power at a microphone."""
        return np.einsum("fii->f", self.products).real / self.products.shape[1]


def cross_spectra(spectra: np.ndarray) -> CrossSpectra:
    """Cross spectra of short spectra (frames, bins, microphones)."""
    by_bin = spectra.transpose(1, 2, 0)
    products = by_bin @ by_bin.conj().transpose(0, 2, 1) / len(spectra)
    # Sound from one place makes one large eigenvalue; the others are what each microphone hears by itself.
    noise = np.linalg.eigvalsh(products)[:, :-1].mean(axis=1)
    return CrossSpectra(products, np.maximum(noise, QUANTUM / FRAME))
