from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.sound.samples import RATE, Sound, pcm16, sine


def test_one_channel_becomes_a_column_and_nobody_can_write_to_it():
    given = np.zeros(10, np.float32)
    sound = Sound(given)
    given[0] = 1.0
    assert sound.samples.shape == (10, 1) and sound.samples[0, 0] == 0.0
    with pytest.raises(ValueError):
        sound.samples[0] = 1.0


def test_integers_are_scaled():
    assert Sound(np.array([-32768, 16384], np.int16)).samples[:, 0].tolist() == [-1.0, 0.5]


@pytest.mark.parametrize("rate", [8000, 16000, 22050, 44100, 96000])
def test_a_tone_stays_the_same_tone_at_another_rate(rate):
    tone = sine(1000.0, 1.0, 0.5, rate).at_rate(RATE)
    assert tone.rate == RATE and tone.frames == RATE
    middle = tone.samples[RATE // 4 : 3 * RATE // 4, 0]
    spectrum = np.abs(np.fft.rfft(middle * np.hanning(len(middle))))
    assert np.argmax(spectrum) * RATE / len(middle) == pytest.approx(1000.0)
    assert np.sqrt(np.mean(middle**2)) == pytest.approx(0.5 / np.sqrt(2.0), rel=0.002)


def test_mono_is_the_mean_of_the_channels():
    assert Sound(np.array([[0.2, 0.6]], np.float32)).mono().samples[0, 0] == pytest.approx(0.4)


def test_a_part_is_cut_out():
    sound = Sound(np.arange(10, dtype=np.float32) / 10.0, 10)
    assert sound.part(0.2, 0.5).samples[:, 0].tolist() == pytest.approx([0.2, 0.3, 0.4])
    assert sound.part(0.8).frames == 2


def test_a_converter_cuts_what_is_too_loud():
    assert pcm16(np.array([2.0, -2.0, 0.5], np.float32)).tolist() == [32767, -32768, 16384]


@pytest.mark.parametrize(
    "samples, rate, word",
    [
        (np.zeros((2, 2, 2)), RATE, "shape"),
        (np.zeros((5, 0)), RATE, "shape"),
        (np.array([np.nan]), RATE, "finite"),
        (np.zeros(5), 0, "rate"),
        (np.zeros(4000), 1, "at most"),
    ],
)
def test_what_is_no_sound_is_refused(samples, rate, word):
    with pytest.raises(BadValue, match=word):
        Sound(samples, rate)
