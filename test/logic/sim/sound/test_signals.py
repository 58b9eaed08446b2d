"""The maths of sound: samples and rates, filters, pitch, delays between samples, levels that change."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.base.samples import RATE, Sound, pcm16, sine
from nao_sim_bridge.sound.ears import REACH, third
from nao_sim_bridge.sound.envelope import Envelope
from nao_sim_bridge.sound.pitch import shifted
from nao_sim_bridge.sound.propagation import FixedWays, arrivals

MIDDLE = slice(RATE // 4, 3 * RATE // 4)
"""Half a second away from the edges."""


def strongest(samples, count=1, rate=RATE):
    """Frequencies of the highest peaks, Hz, in rising order."""
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    peaks = 1 + np.flatnonzero((spectrum[1:-1] > spectrum[:-2]) & (spectrum[1:-1] >= spectrum[2:]))
    return sorted(peaks[np.argsort(spectrum[peaks])[-count:]] * rate / len(samples))


def rms(samples):
    return np.sqrt(np.mean(np.square(samples, dtype=float)))


def wave(frequency, first=0, last=RATE):
    return np.sin(2 * np.pi * frequency / RATE * np.arange(first, last)).astype(np.float32)


def test_samples_are_scaled_mixed_cut_out_and_converted():
    assert Sound(np.array([-32768, 16384], np.int16)).samples[:, 0].tolist() == [-1.0, 0.5]
    assert Sound(np.array([[0.2, 0.6]], np.float32)).mono().samples[0, 0] == pytest.approx(0.4)
    sound = Sound(np.arange(10, dtype=np.float32) / 10.0, 10)
    assert sound.part(0.2, 0.5).samples[:, 0].tolist() == pytest.approx([0.2, 0.3, 0.4])
    assert sound.part(0.8).frames == 2
    assert pcm16(np.array([2.0, -2.0, 0.5], np.float32)).tolist() == [32767, -32768, 16384]


@pytest.mark.parametrize("rate", [8000, 16000, 22050, 44100, 96000])
def test_a_tone_stays_the_same_tone_at_another_rate(rate):
    tone = sine(1000.0, 1.0, 0.5, rate).at_rate(RATE)
    assert tone.rate == RATE and tone.frames == RATE
    assert strongest(tone.samples[MIDDLE, 0]) == pytest.approx([1000.0])
    assert rms(tone.samples[MIDDLE]) == pytest.approx(0.5 / np.sqrt(2.0), rel=0.002)


@pytest.mark.parametrize("frequency", [100.0, 4000.0, 6500.0, 9500.0, 16000.0, 20000.0])
def test_at_a_third_of_the_rate_tones_that_fit_come_without_delay_and_the_others_are_gone(frequency):
    heard = third(wave(frequency, -REACH, 4800 + REACH))
    fits = frequency < 8000.0
    assert heard == pytest.approx(fits * wave(3 * frequency, 0, 1600), abs=0.01 if fits else 1e-3)


@pytest.mark.parametrize("factor", [0.25, 0.8, 1.25, 4.0])
def test_a_tone_moves_by_the_factor_and_keeps_length_and_level(factor):
    result = shifted(0.3 * wave(440.0)[:, np.newaxis], factor, RATE)
    assert result.shape == (RATE, 1)
    assert strongest(result[MIDDLE, 0]) == pytest.approx([440.0 * factor], abs=2.1)
    assert rms(result[MIDDLE]) == pytest.approx(0.3 / np.sqrt(2.0), rel=0.01)


@pytest.mark.parametrize("frequency", [100.0, 1000.0, 8000.0])
@pytest.mark.parametrize("delay", [0.0, 0.25, 5.13, 77.5, 400.999])
def test_a_fixed_way_delays_and_weakens(delay, frequency):
    ways = FixedWays.of(np.array([delay, 7.3]), np.array([0.5, 1.0]))
    before, after = ways.span
    heard = ways.through(wave(frequency, 1000 - before, 3000 + after), 0)
    wanted = 0.5 * np.sin(2 * np.pi * frequency / RATE * (np.arange(1000, 3000) - delay))
    assert heard == pytest.approx(wanted, abs=1e-3)


def test_sound_of_a_moving_source_was_given_off_where_it_was_then():
    """A source that passes at 30 m/s: distance over speed of sound is the travel time, to a hundredth of a frame."""

    def places(frames):
        return np.stack([-5.0 + 30.0 * frames / RATE, np.full(frames.shape, 2.0), np.zeros(frames.shape)], axis=-1)

    frames = np.arange(0, 20000, 400)
    given_off, distances = arrivals(np.zeros((len(frames), 1, 3)), frames, places, RATE / 343.0)
    true = np.linalg.norm(places(given_off), axis=-1)
    assert np.abs((frames[:, None] - given_off) - true * RATE / 343.0).max() < 0.01
    assert distances == pytest.approx(true, abs=1e-3)


def test_an_envelope_stays_until_set_and_then_goes_straight():
    envelope = Envelope((1.0,), 100)
    envelope.set(1000, (0.0,))
    assert envelope.at(999) == (1.0,) and envelope.at(1050) == pytest.approx((0.5,)) and envelope.at(5000) == (0.0,)
    assert envelope.between(0, 1000) == (1.0,) and envelope.between(1100, 2000) == (0.0,)
    assert envelope.between(1000, 1100)[0] == pytest.approx(1.0 - np.arange(100) / 100)


def test_a_change_on_the_way_starts_where_it_is():
    envelope = Envelope((0.0, 1.0), 100)
    envelope.set(0, (1.0, 0.0))
    envelope.set(50, (0.5, 0.5))
    assert np.abs(np.diff(envelope.over(np.arange(0, 300))[0])).max() <= 0.0101
    assert envelope.at(75) == pytest.approx((0.5, 0.5))
