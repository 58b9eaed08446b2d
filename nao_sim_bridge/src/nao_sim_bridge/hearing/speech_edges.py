"""Where speech begins and ends to 5 ms, looked for when it is over. Arithmetic on arrays only.

Voice activity is quick and coarse: it misses weak consonants, which are much of their power above the voice. Here each
band of frequencies is compared with its background, and what is far weaker than the speech itself does not count, so
that in quiet the edges are where a sound file of the speech has them.
"""

from __future__ import annotations

from typing import Tuple

import numpy as np

from nao_sim_bridge.hearing.spectra import frames_of
from nao_sim_bridge.hearing.voice_activity import RATE, Utterance

FRAME, STEP = 320, 80
EDGES_HZ = (200, 600, 1200, 2000, 3000, 4000, 5000, 6500, 8000)
# So many frames are averaged.
RUN = 3
# A band is heard when it is so many standard deviations above its background.
DEVIATIONS = 6.0
# What is weaker beside the loudest frame is no speech, dB.
DEEPEST_DB = -30.0
# Parts with no more silence between them belong together, s: a plosive is silent before it bursts.
GAP_S = 0.12
# The quietest of an utterance stands for a background that was not heard, percent.
QUIETEST = 10.0
LEAST_BACKGROUND = 20 * FRAME


def speech_edges(utterance: Utterance) -> Tuple[float, float]:
    """Times of the first and of the last sound of an utterance, s; its own where it is lost in the background."""
    bands = _bands(utterance.samples)
    if len(utterance.background) >= LEAST_BACKGROUND:
        quiet = _averaged(_bands(utterance.background))
    else:
        least = np.percentile(bands, QUIETEST, axis=0, keepdims=True)
        quiet = np.concatenate([0.5 * least, 1.5 * least])
    noise = quiet.mean(axis=0)
    excess = np.maximum(_averaged(bands) - noise, 0.0)
    heard = (excess > DEVIATIONS * quiet.std(axis=0)).any(axis=1)
    power = excess.sum(axis=1)
    places = np.flatnonzero(heard & (power > 10.0 ** (0.1 * DEEPEST_DB) * power.max()))
    times = utterance.origin + (places * STEP + FRAME / 2.0) / RATE
    sure = np.flatnonzero((times >= utterance.start) & (times <= utterance.end))
    if not len(sure):
        return utterance.start, utterance.end
    apart = np.diff(times) > GAP_S
    before, after = np.flatnonzero(apart[: sure[0]]), np.flatnonzero(apart[sure[-1] :])
    first = before[-1] + 1 if len(before) else 0
    last = sure[-1] + after[0] if len(after) else len(times) - 1
    half = 0.5 * STEP / RATE
    return float(times[first] - half), float(times[last] + half)


def _bands(samples: np.ndarray) -> np.ndarray:
    """(frames, bands) power of (n,) samples of 16 kHz."""
    frames = frames_of(samples, FRAME, STEP)
    power = np.abs(np.fft.rfft(frames * np.hanning(FRAME).astype(np.float32), axis=1)) ** 2
    edges = np.array(EDGES_HZ) * FRAME // RATE
    return np.add.reduceat(power[:, : edges[-1]], edges[:-1], axis=1)


def _averaged(bands: np.ndarray) -> np.ndarray:
    """Mean of each frame and its neighbours."""
    around = np.pad(bands, ((RUN // 2, RUN // 2), (0, 0)), mode="edge")
    return np.mean([around[i : i + len(bands)] for i in range(RUN)], axis=0)
