"""Takes steady background noise out of speech: a Wiener filter that learns the noise from before the speech.

Arithmetic on arrays only.
"""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.hearing.spectra import frames_of

FRAME = 512
STEP = 128
WINDOW = np.sqrt(np.hanning(FRAME + 1)[:FRAME]).astype(np.float32)


def noise_spectrum(background: np.ndarray) -> np.ndarray:
    """Mean power of noise in each band, of (n,) samples without speech, at least one frame of them."""
    return np.mean(np.abs(_spectra(background)) ** 2, axis=0)


def reduce_noise(speech: np.ndarray, noise: np.ndarray, least_gain: float, smoothing: float) -> np.ndarray:
    """Speech, (n,) samples, with less of the noise of `noise_spectrum`; of a band of noise only `least_gain` is left.

    The gain of each band follows the decision-directed estimate of the signal-to-noise ratio, in which the frame before
    has the share `smoothing`.

    Source:
        Y. Ephraim, D. Malah: Speech enhancement using a minimum mean-square error short-time spectral amplitude
        estimator. IEEE Trans. ASSP 32 (1984): the decision-directed a-priori ratio.
    """
    padded = np.concatenate([np.zeros(FRAME, np.float32), speech, np.zeros(FRAME, np.float32)])
    spectra = _spectra(padded)
    ratios = np.abs(spectra) ** 2 / np.maximum(noise, 1e-20)
    gains = np.empty_like(ratios)
    before = np.ones(ratios.shape[1])
    for i, ratio in enumerate(ratios):
        prior = np.maximum(smoothing * before + (1.0 - smoothing) * np.maximum(ratio - 1.0, 0.0), least_gain**2)
        gains[i] = np.maximum(prior / (1.0 + prior), least_gain)
        before = gains[i] ** 2 * ratio
    return _overlap_added(spectra * gains, len(padded))[FRAME : FRAME + len(speech)].astype(np.float32)


def _spectra(samples: np.ndarray) -> np.ndarray:
    return np.fft.rfft(frames_of(samples, FRAME, STEP) * WINDOW, axis=1)


def _overlap_added(spectra: np.ndarray, length: int) -> np.ndarray:
    frames = np.fft.irfft(spectra, FRAME, axis=1) * WINDOW
    total, weight = np.zeros(length), np.zeros(length)
    for i, frame in enumerate(frames):
        total[i * STEP : i * STEP + FRAME] += frame
        weight[i * STEP : i * STEP + FRAME] += WINDOW**2
    return total / np.maximum(weight, 1e-3)
