"""Makes the sounds that worlds have: tones, noises, files, speech. No clock."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import Callable, Sequence

import numpy as np

from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.world.world import WorldSound

Speak = Callable[[str, str], Sound]
"""From a text and the name of a voice to its sound; blocking."""
Read = Callable[[Path], Sound]
"""From a file to its sound; blocking."""

# A sound that does not end is one of this length, repeated, s. Frequencies become multiples of its inverse.
ROUND = 10.0
AMPLITUDE = 0.25
NOISE_RMS = 0.125
# Noise has nothing below, Hz: no air of a room carries it.
LOWEST_NOISE = 20.0
# Beginning and end of a tone or noise that ends, s: they should not click.
FADE = 0.005


def make_sound(sound: WorldSound, speak: Speak, read: Read) -> Sound:
    """What a sound of a world sounds like, pause included, one channel.

    Raises:
        SoundFileError: Its file cannot be read.
        SpeechError: Its text cannot be said.
    """
    if sound.kind == "file":
        made = read(sound.content).mono().at_rate(RATE)
    elif sound.kind == "say":
        made = speak(sound.content, sound.voice).mono().at_rate(RATE)
    elif sound.kind == "tone":
        made = tone(sound.content, sound.duration)
    else:
        made = noise(sound.content, sound.duration, seed=zlib.crc32(sound.name.encode()))
    if sound.pause > 0.0:
        silence = np.zeros((round(sound.pause * RATE), 1), np.float32)
        made = Sound(np.concatenate([made.samples, silence]), RATE)
    return made


def tone(frequencies: Sequence[float], duration: float | None = None) -> Sound:
    """Sines of these frequencies in Hz together; without a duration in s one that can be repeated without a seam."""
    if duration is None:
        frequencies = [max(1, round(frequency * ROUND)) / ROUND for frequency in frequencies]
    steps = np.arange(round((duration or ROUND) * RATE)) / RATE
    waves = sum(np.sin(2.0 * np.pi * frequency * steps) for frequency in frequencies)
    return _faded(waves * (AMPLITUDE / len(frequencies)), duration)


def noise(kind: str, duration: float | None = None, seed: int = 0) -> Sound:
    """White or pink noise; without a duration in s one that can be repeated without a seam."""
    count = round((duration or ROUND) * RATE)
    frequencies = np.fft.rfftfreq(count, 1.0 / RATE)
    shape = np.where(frequencies >= LOWEST_NOISE, 1.0, 0.0)
    if kind == "pink":
        shape = shape / np.sqrt(np.maximum(frequencies, LOWEST_NOISE))
    chance = np.random.default_rng(seed)
    wave = np.fft.irfft(np.fft.rfft(chance.standard_normal(count)) * shape, count)
    return _faded(wave * (NOISE_RMS / max(float(np.sqrt(np.mean(wave**2))), 1e-12)), duration)


def _faded(wave: np.ndarray, duration: float | None) -> Sound:
    if duration is not None:
        length = min(round(FADE * RATE), len(wave) // 2)
        ramp = np.arange(length) / max(length, 1)
        wave[:length] *= ramp
        wave[len(wave) - length :] *= ramp[::-1]
    return Sound(wave.astype(np.float32), RATE)
