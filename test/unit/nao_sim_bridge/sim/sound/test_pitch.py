"""Sounds get higher or lower, and stay as long and as loud as they were."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.pitch import shifted

RATE = 48000
MIDDLE = slice(RATE // 4, RATE // 4 + RATE // 2)
"""Half a second away from the edges."""


def tones(*pitches):
    time = np.arange(RATE) / RATE
    return (0.3 * sum(np.sin(2.0 * np.pi * pitch * time) for pitch in pitches))[:, np.newaxis]


def strongest(samples, count=1):
    """Frequencies of the highest peaks, Hz, in their order."""
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    peaks = 1 + np.flatnonzero((spectrum[1:-1] > spectrum[:-2]) & (spectrum[1:-1] >= spectrum[2:]))
    best = peaks[np.argsort(spectrum[peaks])[-count:]]
    return sorted(best * RATE / len(samples))


@pytest.mark.parametrize("factor", [0.25, 0.5, 0.8, 1.25, 2.0, 4.0])
def test_a_tone_moves_by_the_factor_and_keeps_length_and_level(factor):
    result = shifted(tones(440.0), factor, RATE)
    assert result.shape == (RATE, 1)
    assert strongest(result[MIDDLE, 0]) == pytest.approx([440.0 * factor], abs=2.1)
    assert np.sqrt(np.mean(result[MIDDLE] ** 2)) == pytest.approx(0.3 / np.sqrt(2.0), rel=0.01)


def test_a_chord_stays_a_chord():
    result = shifted(tones(440.0, 554.0, 660.0), 1.5, RATE)
    assert strongest(result[MIDDLE, 0], 3) == pytest.approx([660.0, 831.0, 990.0], abs=2.1)


def test_what_begins_late_still_begins_late():
    sound = tones(440.0)
    sound[: RATE // 2] = 0.0
    result = shifted(sound, 1.5, RATE)[:, 0]
    assert np.abs(result[: RATE // 2 - 2048]).max() < 0.01
    assert np.abs(result[RATE // 2 + 2048 : RATE // 2 + 4096]).max() > 0.25


def test_channels_are_changed_one_by_one():
    both = np.hstack([tones(400.0), tones(600.0)])
    result = shifted(both, 2.0, RATE)
    assert strongest(result[MIDDLE, 0]) == pytest.approx([800.0], abs=2.1)
    assert strongest(result[MIDDLE, 1]) == pytest.approx([1200.0], abs=2.1)


def test_the_own_pitch_changes_nothing():
    np.testing.assert_array_equal(shifted(tones(440.0), 1.0, RATE), tones(440.0).astype(np.float32))


@pytest.mark.parametrize("frames", [0, 1, 100, 5000])
def test_short_sounds_keep_their_length(frames):
    assert shifted(tones(440.0)[:frames], 2.0, RATE).shape == (frames, 1)
