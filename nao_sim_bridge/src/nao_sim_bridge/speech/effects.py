"""What is done to the sound of a voice: loudness, pitch, a second voice. Arithmetic only."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.sound.pitch import shifted
from nao_sim_bridge.speech.parameters import DoubleVoice

# Loudness of all voices while they speak, and the highest peak, as parts of full scale. The peak leaves room for the
# volume of 100 %, which is 2 dB more than that of the start.
LOUDNESS = 0.16
HIGHEST_PEAK = 0.8
# What is less than this part of the loudest is no speech, in blocks of so many s.
SPEAKING = 0.1
BLOCK = 0.02
# Length of the pieces that the pitch is changed in, s: four periods of a low voice.
PITCH_WINDOW = 0.04


def levelled(samples: np.ndarray, rate: int) -> np.ndarray:
    """(frames,) samples as loud as every voice is."""
    size = max(round(BLOCK * rate), 1)
    blocks = samples[: len(samples) // size * size].reshape(-1, size)
    if not len(blocks):
        return samples
    levels = np.sqrt(np.mean(np.square(blocks, dtype=np.float64), axis=1))
    speaking = levels[levels > SPEAKING * levels.max()]
    if not len(speaking):
        return samples
    gain = min(LOUDNESS / float(np.sqrt(np.mean(np.square(speaking)))), HIGHEST_PEAK / float(np.abs(samples).max()))
    return (samples * gain).astype(np.float32)


def higher(samples: np.ndarray, factor: float, rate: int) -> np.ndarray:
    """(frames,) samples with all frequencies times `factor`, as long as before."""
    if factor == 1.0 or not len(samples):
        return samples
    window = 4 * round(PITCH_WINDOW * rate / 4)
    return shifted(samples[:, None], factor, rate, window)[:, 0]


def doubled(samples: np.ndarray, second: np.ndarray, voice: DoubleVoice, rate: int) -> np.ndarray:
    """Samples of a voice and of its second one together, longer by the delay of the second.

    The level is that of the second against the first, so it leaves the loudness of both together as it is.
    """
    delay = round(voice.delay * rate)
    both = np.zeros(len(samples) + delay, dtype=np.float32)
    both[: len(samples)] = samples
    both[delay : delay + len(second)] += voice.level * second
    return both / np.float32(np.sqrt(1.0 + voice.level**2))
