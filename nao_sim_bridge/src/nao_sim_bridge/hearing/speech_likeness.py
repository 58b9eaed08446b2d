"""Tells noises, tones and hums from speech: a recogniser would take them for words. Arithmetic on arrays only.

Speech has voiced parts: they repeat themselves with the pitch of the voice, which noise of any colour does not. And the
shape of its spectrum changes, which that of a tone or a hum does not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.hearing.spectra import frames_of
from nao_sim_bridge.hearing.voice_activity import RATE

FRAME, STEP = 512, 160
# Frames this far below the loudest one, in power, do not count.
LOUD = 1e-2
BANDS_HZ = np.geomspace(150.0, 5000.0, 19)
# Bins on each side of the strongest one that belong to a tone: the window smears it that far.
SMEAR = 2
# Pitch of voices, Hz, and the frequencies in which it is looked for: formants, not rumbling and not hiss.
LEAST_PITCH, MOST_PITCH = 70.0, 400.0
VOICE_BAND_HZ = (100.0, 2500.0)
VOICE_FRAME, VOICE_BINS = 640, 2048
# So many of the frames of a word are less voiced than the figure for it, percent.
UNVOICED = 80.0
# Bands are no weaker than this beside the strongest of a frame, in power.
DEEPEST = 1e-3


@dataclass(frozen=True)
class Likeness:
    """What tells speech from noises and tones.

    The voice is how much the most voiced parts repeat themselves, 0..1. The tone is the share of the power that one
    single tone has in each loud frame, 0..1, on average. The change is that of the shape of the spectrum while it
    sounds, dB.
    """

    voice: float
    tone: float
    change: float


def likeness(samples: np.ndarray) -> Likeness:
    """Measure (n,) samples of 16 kHz, at least one frame of them that is not silent."""
    power = np.abs(np.fft.rfft(frames_of(samples, FRAME, STEP) * np.hanning(FRAME), axis=1)) ** 2
    total = power.sum(axis=1)
    power = power[total > LOUD * max(float(total.max()), 1e-20)]
    if not len(power):
        return Likeness(0.0, 0.0, 0.0)
    return Likeness(_voice(samples), _tone_share(power), _change(power))


def _voice(samples: np.ndarray) -> float:
    frames = frames_of(np.diff(samples, prepend=0.0), VOICE_FRAME, STEP)
    power = np.abs(np.fft.rfft(frames * np.hanning(VOICE_FRAME), VOICE_BINS, axis=1)) ** 2
    low, high = (round(edge * VOICE_BINS / RATE) for edge in VOICE_BAND_HZ)
    power[:, :low] = 0.0
    power[:, high:] = 0.0
    likenesses = np.fft.irfft(power, axis=1)
    energy = likenesses[:, 0]
    likenesses = likenesses[energy > LOUD * max(float(energy.max()), 1e-20)]
    if not len(likenesses):
        return 0.0
    periods = slice(round(RATE / MOST_PITCH), round(RATE / LEAST_PITCH) + 1)
    return float(np.percentile((likenesses[:, periods] / likenesses[:, :1]).max(axis=1), UNVOICED))


def _tone_share(power: np.ndarray) -> float:
    shares = []
    for frame, peak in zip(power, power.argmax(axis=1)):
        shares.append(frame[max(peak - SMEAR, 0) : peak + SMEAR + 1].sum() / frame.sum())
    return float(np.mean(shares))


def _change(power: np.ndarray) -> float:
    edges = np.round(BANDS_HZ * FRAME / RATE).astype(int)
    bands = np.add.reduceat(power[:, : edges[-1]], edges[:-1], axis=1) / np.diff(edges)
    bands = np.maximum(bands, DEEPEST * bands.max(axis=1, keepdims=True))
    levels = 10.0 * np.log10(bands)
    shapes = levels - levels.mean(axis=1, keepdims=True)
    return float(shapes.std(axis=0).mean())
