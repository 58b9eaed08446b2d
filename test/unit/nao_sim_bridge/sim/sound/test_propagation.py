from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.propagation import MARGIN, arrivals, at_places, delayed, doubled

RATE = 48000


def tone(frequency):
    return lambda first, last: np.sin(2 * np.pi * frequency / RATE * np.arange(first, last)).astype(np.float32)


@pytest.mark.parametrize("frequency", [100.0, 1000.0, 4000.0, 8000.0])
def test_a_tone_between_samples_is_right_within_a_tenth_of_a_decibel(frequency):
    places = 5000.0 + np.arange(4000) * 1.0 + 0.37
    heard = at_places(tone(frequency), places)
    wanted = np.sin(2 * np.pi * frequency / RATE * places)
    level = 20 * np.log10(np.sqrt(np.mean(heard**2)) / np.sqrt(np.mean(wanted**2)))
    assert abs(level) < 0.1
    assert np.abs(heard - wanted).max() < 0.006


@pytest.mark.parametrize("delay", [0.0, 0.25, 5.13, 77.5, 400.999])
def test_a_fixed_delay_is_right(delay):
    heard = delayed(tone(2000.0), 1000, 3000, np.array([delay, 3.0]))
    wanted = np.sin(2 * np.pi * 2000.0 / RATE * (np.arange(1000, 3000) - delay))
    assert np.abs(heard[0] - wanted).max() < 2e-3
    assert np.abs(heard[1] - np.sin(2 * np.pi * 2000.0 / RATE * (np.arange(1000, 3000) - 3))).max() < 2e-3


def test_both_ways_agree():
    delays = np.array([10.3, 20.9])
    places = np.arange(1000, 1500)[None] - delays[:, None]
    assert at_places(tone(3000.0), places) == pytest.approx(delayed(tone(3000.0), 1000, 1500, delays), abs=1e-5)


def test_the_double_rate_keeps_the_samples():
    signal = np.random.default_rng(0).normal(size=200).astype(np.float32)
    assert np.array_equal(doubled(signal)[0::2][:5], signal[19:24])


def test_it_asks_for_no_more_than_its_margin():
    asked = []
    at_places(lambda first, last: asked.append((first, last)), np.array([100.0, 200.5]))
    assert asked == [(100 - MARGIN, 201 + MARGIN + 1)]


def test_sound_of_a_moving_source_was_given_off_where_it_was_then():
    """A source that passes at 30 m/s: distance over speed of sound is the travel time, to the thousandth of a frame."""

    def places(frames):
        return np.stack([-5.0 + 30.0 * frames / RATE, np.full(frames.shape, 2.0), np.zeros(frames.shape)], axis=-1)

    frames = np.arange(0, 20000, 400)
    microphones = np.zeros((len(frames), 1, 3))
    given_off, distances = arrivals(microphones, frames, places, RATE / 343.0)
    true = np.linalg.norm(places(given_off), axis=-1)
    assert np.abs((frames[:, None] - given_off) - true * RATE / 343.0).max() < 0.01
    assert distances == pytest.approx(true, abs=1e-3)
