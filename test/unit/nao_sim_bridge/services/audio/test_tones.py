"""Tones: frequency, level, length, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.services.audio.tones import side, sine
from nao_sim_bridge.sim.errors import BadValue


def test_a_tone_has_its_frequency_level_and_length():
    sound = sine(1000, 50, 1.0)
    assert (sound.rate, sound.frames, sound.channels) == (48000, 48000, 1)
    samples = sound.samples[:, 0]
    spectrum = np.abs(np.fft.rfft(samples))
    assert np.argmax(spectrum) == 1000
    assert np.abs(samples).max() == pytest.approx(0.5, abs=1e-3)
    assert np.sqrt(np.mean(samples**2)) == pytest.approx(0.5 / np.sqrt(2.0), rel=0.01)


def test_it_swells_and_fades_within_milliseconds():
    samples = np.abs(sine(5000, 100, 0.1).samples[:, 0])
    assert samples[:5].max() < 0.1 and samples[-5:].max() < 0.1
    assert samples[150:250].max() > 0.95 and samples[-250:-150].max() > 0.95


def test_a_long_tone_does_not_drift():
    samples = sine(441, 100, 60.0).samples[-4800 - 96 : -96, 0]
    time = np.arange(60 * 48000 - 4800 - 96, 60 * 48000 - 96) / 48000
    np.testing.assert_allclose(samples, np.sin(2.0 * np.pi * 441 * time), atol=1e-3)


@pytest.mark.parametrize("duration", [0.0001, 0.001])
def test_a_very_short_tone_is_possible(duration):
    assert sine(1000, 50, duration).frames == round(duration * 48000)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((0, 50, 1.0), "frequence is 0, allowed is 1 to 20000"),
        ((20001, 50, 1.0), "frequence is 20001"),
        ((440, 101, 1.0), "gain is 101, allowed is 0 to 100"),
        ((440, -1, 1.0), "gain is -1"),
        ((440, 50, 0.0), "duration is 0.0, allowed is above 0 to 600"),
        ((440, 50, -1.0), "duration is -1.0"),
        ((440, 50, float("nan")), "duration is nan"),
        ((440, 50, 1e9), "duration is 1000000000.0"),
    ],
)
def test_what_is_no_tone_is_refused(arguments, message):
    with pytest.raises(BadValue, match=message):
        sine(*arguments)


def test_sides():
    assert [side(-1), side(0), side(1)] == [-1.0, 0.0, 1.0]
    with pytest.raises(BadValue, match="pan is 2, allowed is -1"):
        side(2)
