"""Noises, tones and hums are told from speech by numbers."""

from __future__ import annotations

from dataclasses import astuple

import numpy as np
import pytest
from fake_speech import RATE, spoken

from nao_sim_bridge.sim.hearing.settings import load_recognition
from nao_sim_bridge.sim.hearing.speech_likeness import likeness

TIMES = np.arange(RATE) / RATE
BOUNDS = load_recognition().speech_likeness


def test_a_tone_is_all_tone_and_does_not_change():
    found = likeness(np.sin(2.0 * np.pi * 440.0 * TIMES))
    assert found.tone > BOUNDS.most_tone
    assert found.change < 0.1


def test_a_hum_does_not_change():
    found = likeness(sum(np.sin(2.0 * np.pi * 150.0 * k * TIMES) / k for k in range(1, 9)))
    assert found.change < BOUNDS.least_change


@pytest.mark.parametrize("power", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("seed", range(20))
def test_noise_of_any_colour_and_length_has_no_voice(power, seed):
    random = np.random.default_rng(seed)
    frames = round(random.uniform(0.2, 2.0) * RATE)
    spectrum = np.fft.rfft(random.standard_normal(frames)) / np.arange(1.0, frames // 2 + 2.0) ** power
    assert likeness(np.fft.irfft(spectrum, frames)).voice < BOUNDS.least_voice


@pytest.mark.parametrize("text", ["yes", "good morning", "stop", "six", "sit down"])
def test_speech_is_within_the_bounds(text):
    found = likeness(spoken(text))
    assert found.voice > BOUNDS.least_voice
    assert found.tone < BOUNDS.most_tone
    assert found.change > BOUNDS.least_change


def test_the_level_does_not_matter():
    speech = spoken("yes")
    loud, quiet = likeness(speech), likeness(1e-3 * speech)
    assert astuple(loud) == pytest.approx(astuple(quiet), rel=1e-3)


@pytest.mark.parametrize("frames", [1, 100, 4000])
def test_silence_and_clicks_are_measured(frames):
    assert likeness(np.zeros(frames)).change == 0.0
    assert 0.0 <= likeness(np.eye(1, frames)[0]).tone <= 1.0
