"""What four microphones hear of a sound from afar, and of noise; exact delays, worked out in the frequency domain."""

from __future__ import annotations

import numpy as np

RATE = 48000
BLOCK = 8160
# Left, right, front and rear of NAOqi on a V6 head, in the frame of the head, m.
PLACES = np.array(
    [
        [-0.021544, 0.055772, 0.077426],
        [-0.021543, -0.055772, 0.077426],
        [0.020626, 0.030938, 0.098582],
        [0.020627, -0.030938, 0.098582],
    ]
)
FULL_SCALE_DB = 104.0
SPEED = 343.0


def rms(level_db):
    """Root mean square of int16 samples at a level in dB SPL."""
    return 32768.0 * 10.0 ** ((level_db - FULL_SCALE_DB) / 20.0) / np.sqrt(2.0)


def noise(chance, kind="white", frames=BLOCK):
    """Noise of root mean square 1."""
    spectrum = np.fft.rfft(chance.standard_normal(frames))
    spectrum /= np.arange(1, len(spectrum) + 1) ** {"white": 0.0, "pink": 0.5, "brown": 1.0}[kind]
    wave = np.fft.irfft(spectrum, frames)
    return wave / np.sqrt(np.mean(wave**2))


def harmonics(chance, frames=BLOCK):
    """A tone with overtones, root mean square 1."""
    steps = 2.0 * np.pi * chance.uniform(150.0, 500.0) * np.arange(frames) / RATE
    wave = sum(np.sin(k * steps + chance.uniform(0.0, 6.28)) / k for k in range(1, 9))
    return wave / np.sqrt(np.mean(wave**2))


def background(chance, level_db=30.0, frames=BLOCK, kind="white"):
    """(frames, 4) of noise that each microphone has for itself, not rounded."""
    return np.stack([noise(chance, kind, frames) for _ in PLACES], axis=1) * rms(level_db)


def heard(wave, toward, distance=2.0, level_db=65.0):
    """(frames, 4) of a source, not rounded.

    Args:
        wave: (frames,) of root mean square 1.
        toward: (3,) unit vector in the frame of the head, from the middle of the microphones.
        distance: m.
        level_db: At 1 m.
    """
    source = PLACES.mean(axis=0) + distance * np.asarray(toward)
    padded = np.concatenate([wave, np.zeros(16384 - len(wave) % 16384)])
    spectrum = np.fft.rfft(padded)
    turns = 2j * np.pi * np.fft.rfftfreq(len(padded), 1.0 / RATE)
    ways = np.linalg.norm(PLACES - source, axis=1)
    # The first 0.2 m are left out: what comes before the block would be missing else.
    waves = [
        np.fft.irfft(spectrum * np.exp(-turns * (way - distance + 0.2) / SPEED), len(padded)) / way for way in ways
    ]
    return np.stack(waves, axis=1)[: len(wave)] * rms(level_db)


def rounded(samples):
    """int16 as the converter makes them."""
    return np.clip(np.rint(samples), -32768, 32767).astype(np.int16)
