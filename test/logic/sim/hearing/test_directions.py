"""Sounds are found where they are; noise from nowhere, silence and the own voice are not. And when sounds begin."""

from __future__ import annotations

import math

import numpy as np
import pytest
from ear_sounds import BLOCK, PLACES, RATE, background, harmonics, heard, noise, rms, rounded

from nao_sim_bridge.hearing.detection import END, START, SoundDetector
from nao_sim_bridge.hearing.localisation import direction, microphone_array
from nao_sim_bridge.hearing.localiser import Localiser

ARRAY = microphone_array(PLACES)
BLOCK_S = BLOCK / RATE
FRAME_S = 0.022
"""Nothing is known more exactly of a sound's begin than the frames in which powers are measured, s."""


@pytest.fixture
def localiser():
    return Localiser(ARRAY, RATE)


@pytest.fixture
def chance():
    return np.random.default_rng(11)


def test_directions_are_counted_from_ahead_to_the_left_and_upwards():
    assert direction(0.0, 0.0) == pytest.approx([1.0, 0.0, 0.0])
    assert direction(math.pi / 2, 0.0) == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)
    assert direction(0.3, math.pi / 2) == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)


@pytest.mark.parametrize("azimuth, elevation", [(0, 0), (0, -20), (30, 10), (-120, 0), (180, 25), (150, -10)])
def test_a_sound_is_found_where_the_geometry_tells(chance, localiser, azimuth, elevation):
    toward = direction(math.radians(azimuth), math.radians(elevation))
    samples = rounded(heard(noise(chance), toward) + background(chance))
    found = localiser.feed(samples, 3.5)
    assert math.degrees(found.elevation) == pytest.approx(elevation, abs=3.0)
    assert (math.degrees(found.azimuth) - azimuth + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=2.0)
    assert found.energy == pytest.approx(np.sqrt(np.mean(samples.astype(float) ** 2)), rel=1e-3)
    assert found.time == pytest.approx(3.5, abs=FRAME_S)


def test_a_turned_head_knows_where_up_is(chance, localiser):
    # The head looks up by 25 degrees: a source at its height is below, in its frame.
    up = (math.sin(math.radians(25.0)), 0.0, math.cos(math.radians(25.0)))
    toward = direction(0.0, math.radians(-25.0))
    found = localiser.feed(rounded(heard(noise(chance), toward) + background(chance)), 0.0, up)
    assert math.degrees(found.elevation) == pytest.approx(-25.0, abs=3.0)
    assert math.degrees(found.azimuth) == pytest.approx(0.0, abs=2.0)


def test_confidence_is_high_for_one_clear_source_and_lower_in_noise(chance):
    source = heard(noise(chance), direction(0.5, 0.0), level_db=60.0)
    clear = Localiser(ARRAY, RATE).feed(rounded(source + background(chance)), 0.0)
    noisy = Localiser(ARRAY, RATE).feed(rounded(source + background(chance, 52.0)), 0.0)
    assert clear.confidence > 0.95 and 0.3 <= noisy.confidence < clear.confidence


@pytest.mark.parametrize("kind", ["white", "pink", "brown"])
def test_noise_from_nowhere_and_silence_are_not_located(chance, kind):
    for level_db in (30.0, 60.0, 90.0):
        localiser = Localiser(ARRAY, RATE)
        for number in range(5):
            assert localiser.feed(rounded(background(chance, level_db, kind=kind)), number * BLOCK_S) is None
    assert Localiser(ARRAY, RATE).feed(np.zeros((BLOCK, 4), np.int16), 0.0) is None


def test_a_steady_sound_becomes_background_and_does_not_hide_a_voice(chance, localiser):
    found = []
    fan = [heard(noise(chance, "pink"), direction(2.0, 0.0), level_db=50.0) for _ in range(8)]
    for number in range(100):
        found.append(localiser.feed(rounded(fan[number % 8] + background(chance)), number * BLOCK_S))
    assert found[0].azimuth == pytest.approx(2.0, abs=0.1)
    assert found[-10:] == [None] * 10
    voice = heard(harmonics(chance), direction(-0.5, 0.0), level_db=50.0)
    both = localiser.feed(rounded(fan[0] + voice + background(chance)), 100 * BLOCK_S)
    assert both.azimuth == pytest.approx(-0.5, abs=0.06)


@pytest.fixture
def detector():
    return SoundDetector(RATE)


def edges(detector, samples, time=0.0):
    found = []
    for start in range(0, len(samples) - BLOCK + 1, BLOCK):
        block = detector.feed(rounded(samples[start : start + BLOCK]), time + start / RATE)
        assert all(0 <= edge.index < BLOCK and 0.0 <= edge.confidence <= 1.0 for edge in block)
        found += block
    return found


def room(chance, seconds, *sounds, level_db=30.0, kind="white"):
    """Background, and sounds (start in s, seconds, kind, level in dB) that all microphones hear alike."""
    samples = background(chance, level_db, int(seconds * RATE), kind)
    for start, duration, sound, level in sounds:
        first, count = int(start * RATE), int(duration * RATE)
        samples[first : first + count] += (noise(chance, sound, max(count, RATE))[:count] * rms(level))[:, None]
    return samples


def test_a_sound_begins_and_ends(detector, chance):
    start, end = edges(detector, room(chance, 4.0, (1.5, 0.8, "white", 60.0)), time=10.0)
    assert (start.kind, end.kind) == (START, END)
    assert start.time == pytest.approx(11.5, abs=FRAME_S)
    assert end.time == pytest.approx(12.3, abs=2 * FRAME_S)
    assert start.index == pytest.approx((1.5 * RATE) % BLOCK, abs=FRAME_S * RATE)
    assert start.confidence > 0.7


def test_words_with_short_pauses_are_one_sound(detector, chance):
    found = edges(detector, room(chance, 4.0, *((1.0 + 0.3 * word, 0.2, "pink", 60.0) for word in range(5))))
    assert [edge.kind for edge in found] == [START, END]
    assert found[1].time - found[0].time == pytest.approx(1.4, abs=3 * FRAME_S)


@pytest.mark.parametrize("kind", ["white", "pink", "brown"])
def test_steady_noise_is_no_sound_and_silence_is_none(detector, chance, kind):
    assert edges(detector, room(chance, 5.0, level_db=60.0, kind=kind)) == []
    assert edges(SoundDetector(RATE), np.zeros((2 * RATE, 4))) == []


def test_a_soft_sound_needs_a_sensitive_ear(chance):
    samples = room(chance, 3.0, (1.0, 0.5, "white", 42.0))
    for sensitivity, count in ((1.0, 2), (0.9, 2), (0.5, 0), (0.0, 0)):
        detector = SoundDetector(RATE)
        detector.sensitivity = sensitivity
        assert len(edges(detector, samples)) == count, sensitivity


def test_the_own_voice_is_nobody_else(chance, localiser):
    samples = rounded(heard(noise(chance), direction(0.5, 0.0)) + background(chance))
    power = float(np.mean(samples.astype(float) ** 2))
    assert localiser.feed(samples, 0.0, own_power=lambda: 0.5 * power) is None
    assert localiser.feed(samples, BLOCK_S, own_power=lambda: 0.02 * power) is not None
