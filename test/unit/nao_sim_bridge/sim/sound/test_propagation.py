from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.sound.propagation import MARGIN, FixedWays, arrivals, at_places, doubled

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


@pytest.mark.parametrize("frequency", [100.0, 1000.0, 8000.0])
@pytest.mark.parametrize("delay", [0.0, 0.25, 5.13, 77.5, 400.999])
def test_a_fixed_way_delays_and_weakens(delay, frequency):
    ways = FixedWays.of(np.array([delay, 7.3]), np.array([0.5, 1.0]))
    before, after = ways.span
    heard = ways.through(tone(frequency)(1000 - before, 3000 + after), 0)
    wanted = 0.5 * np.sin(2 * np.pi * frequency / RATE * (np.arange(1000, 3000) - delay))
    assert heard == pytest.approx(wanted, abs=1e-3)


def test_two_fixed_ways_at_once_are_their_sum():
    ways = FixedWays.of(np.array([[3.2, 8.0], [10.7, 4.0]]), np.array([[0.5, 1.0], [0.2, 1.0]]))
    before, after = ways.span
    signal = tone(700.0)(1000 - before, 1500 + after)
    both = ways.through(signal, (slice(None), 0))
    assert both == pytest.approx(ways.through(signal, (0, 0)) + ways.through(signal, (1, 0)), abs=1e-6)


def test_both_kinds_of_ways_agree():
    ways = FixedWays.of(np.array([10.3]), np.array([1.0]))
    before, after = ways.span
    fixed = ways.through(tone(3000.0)(1000 - before, 1500 + after), 0)
    assert at_places(tone(3000.0), np.arange(1000, 1500) - 10.3) == pytest.approx(fixed, abs=1e-3)


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
