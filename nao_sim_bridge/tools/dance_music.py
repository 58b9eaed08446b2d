"""The music of the dance: drums, a bass and a melody over four chords, computed."""

from __future__ import annotations

import numpy as np

BEATS = 34
"""Two more than the dance has: the last chord fades."""
CHORDS = ((220.0, 261.6, 329.6), (174.6, 220.0, 261.6), (261.6, 329.6, 392.0), (196.0, 246.9, 293.7))
"""Hz; A minor, F, C, G: four beats each."""
MELODY = (2, 1, 2, 0, 2, 1, 0, 1)
"""Which note of the chord an octave higher sounds on each half beat, over two bars."""


def dance_music(tempo: float, rate: int, random: np.random.Generator) -> np.ndarray:
    """The samples, `rate` a second, of `tempo` beats a minute; `random` is for the noise of the drums."""
    beat = 60.0 / tempo
    total = np.zeros(round((BEATS * beat + 0.5) * rate))
    for number in range(BEATS):
        chord, last = CHORDS[number // 4 % 4], number >= BEATS - 2
        _add(total, _kick(rate), number * beat, 0.9, rate)
        _add(total, _tone(chord[0] / 2.0, 0.9 * beat, 3.0, rate), number * beat, 0.45, rate)
        if last:
            for pitch in chord:
                _add(total, _tone(pitch, 2.0 * beat, 1.5, rate), number * beat, 0.12, rate)
            continue
        if number % 2:
            _add(total, _noise(0.18, 22.0, rate, random), number * beat, 0.16, rate)
        for half in (0, 1):
            _add(total, _noise(0.05, 90.0, rate, random), (number + 0.5 * half) * beat, 0.06, rate)
            pitch = 2.0 * chord[MELODY[(2 * number + half) % len(MELODY)]]
            _add(total, _tone(pitch, 0.5 * beat, 6.0, rate), (number + 0.5 * half) * beat, 0.22, rate)
    return np.tanh(1.5 * total)


def _add(total: np.ndarray, sound: np.ndarray, begin: float, level: float, rate: int) -> None:
    first = round(begin * rate)
    part = sound[: len(total) - first]
    total[first : first + len(part)] += level * part


def _tone(pitch: float, duration: float, decay: float, rate: int) -> np.ndarray:
    time = np.arange(round(duration * rate)) / rate
    wave = sum(np.sin(2.0 * np.pi * pitch * k * time) / k**2 for k in (1, 2, 3))
    return wave * np.exp(-decay * time) * np.minimum(1.0, time / 0.005) * np.minimum(1.0, (duration - time) / 0.02)


def _kick(rate: int) -> np.ndarray:
    time = np.arange(round(0.25 * rate)) / rate
    phase = 2.0 * np.pi * np.cumsum(50.0 + 90.0 * np.exp(-30.0 * time)) / rate
    return np.sin(phase) * np.exp(-14.0 * time)


def _noise(duration: float, decay: float, rate: int, random: np.random.Generator) -> np.ndarray:
    time = np.arange(round(duration * rate)) / rate
    return np.diff(random.standard_normal(len(time) + 1)) * np.exp(-decay * time)
