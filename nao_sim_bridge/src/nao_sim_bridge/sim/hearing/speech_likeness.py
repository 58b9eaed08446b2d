"""Tells a tone or a hum from speech, which a recogniser of words would take for a vowel. Arithmetic on arrays only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.sim.hearing.voice_activity import RATE

FRAME, STEP = 512, 160
# Frames this far below the loudest one, in power, do not count.
LOUD = 1e-2
BANDS_HZ = np.geomspace(150.0, 5000.0, 19)
# Bins on each side of the strongest one that belong to a tone: the window smears it that far.
SMEAR = 2
# Bands are no weaker than this beside the strongest of a frame, in power.
DEEPEST = 1e-3


@dataclass(frozen=True)
class Likeness:
    """What tells speech from tones.

    Attributes:
        tone: Share of the power that one single tone has in each loud frame, 0..1, on average.
        change: How much the shape of the spectrum changes while it sounds, dB.
    """

    tone: float
    change: float


def likeness(samples: np.ndarray) -> Likeness:
    """Measure (n,) samples of 16 kHz, at least one frame of them that is not silent."""
    padded = np.pad(samples, (0, max(FRAME - len(samples), 0)))
    frames = np.lib.stride_tricks.sliding_window_view(padded, FRAME)[::STEP]
    power = np.abs(np.fft.rfft(frames * np.hanning(FRAME), axis=1)) ** 2
    total = power.sum(axis=1)
    power = power[total > LOUD * max(float(total.max()), 1e-20)]
    if not len(power):
        return Likeness(0.0, 0.0)
    return Likeness(_tone_share(power), _change(power))


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
