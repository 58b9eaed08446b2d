"""Real speech of small programs, as a microphone 1 m away would hear it, 16 kHz."""

from __future__ import annotations

import atexit
from functools import lru_cache

import numpy as np

from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.speech.engines import Engines, Utterance

RATE = 16000
BLOCK = 2720
LEVEL = 10.0 ** (-39.0 / 20.0)
ROOM = 10.0 ** (-74.0 / 20.0)


@lru_cache(maxsize=None)
def _engines():
    made = Engines()
    atexit.register(made.close)
    return made


@lru_cache(maxsize=None)
def spoken(text, voice="slt"):
    """(n,) samples of a text as flite says it, with the level of a person 1 m away."""
    speech = _engines().synthesise(Utterance("flite", voice, text))
    samples = Sound(np.asarray(speech.samples), speech.rate).at_rate(RATE).mono().samples[:, 0]
    loud = np.abs(samples) > 0.1 * np.abs(samples).max()
    return samples * (LEVEL / np.sqrt(np.mean(samples[loud] ** 2)))


def in_a_room(*sounds, pause=1.1, noise=ROOM, seed=1):
    """Sounds one after the other with pauses around them, in white noise; int16."""
    parts = [np.zeros(round(pause * RATE))]
    for sound in sounds:
        parts += [sound, np.zeros(round(pause * RATE))]
    stream = np.concatenate(parts)
    stream = stream + noise * np.random.default_rng(seed).standard_normal(len(stream))
    return np.round(np.clip(stream, -1.0, 1.0) * 32767.0).astype(np.int16)


def blocks(stream):
    """(time in s, samples) of each whole block."""
    return [(i / RATE, stream[i : i + BLOCK]) for i in range(0, len(stream) - BLOCK + 1, BLOCK)]


def audible(speech):
    """When the first and the last sound of speech are, s: within 30 dB of the loudest, with gaps of up to 0.12 s."""
    step = RATE // 200
    parts = speech[: len(speech) // step * step].reshape(-1, step)
    power = np.mean(parts**2, axis=1)
    loud = np.flatnonzero(power > 1e-3 * np.convolve(power, np.full(4, 0.25), "same").max())
    groups = np.split(loud, np.flatnonzero(np.diff(loud) > round(0.12 * RATE / step)) + 1)
    (main,) = (group for group in groups if power.argmax() in group)
    return main[0] * step / RATE, (main[-1] + 1) * step / RATE
