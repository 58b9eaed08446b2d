"""Sounds begin and end when they do; what goes on steadily is no sound."""

from __future__ import annotations

import numpy as np
import pytest
from ear_sounds import BLOCK, RATE, background, noise, rms, rounded

from nao_sim_bridge.sim.hearing.detection import END, START, SoundDetector

FRAME_S = 0.022
"""Nothing is known more exactly than the frames in which powers are measured, s."""


@pytest.fixture
def chance():
    return np.random.default_rng(5)


@pytest.fixture
def detector():
    return SoundDetector(RATE)


def edges(detector, samples, time=0.0):
    found = []
    for start in range(0, len(samples) - BLOCK + 1, BLOCK):
        block = detector.feed(rounded(samples[start : start + BLOCK]), time + start / RATE)
        for edge in block:
            assert 0 <= edge.index < BLOCK
            assert 0.0 <= edge.confidence <= 1.0
        found += block
    return found


def room(chance, seconds, level_db=30.0, kind="white"):
    return background(chance, level_db, int(seconds * RATE), kind)


def put(samples, start, seconds, wave, level_db):
    """Add a sound that all microphones hear alike."""
    first, count = int(start * RATE), int(seconds * RATE)
    samples[first : first + count] += (wave[:count] * rms(level_db))[:, None]


def test_a_sound_begins_and_ends(detector, chance):
    samples = room(chance, 4.0)
    put(samples, 1.5, 0.8, noise(chance, frames=RATE), 60.0)
    start, end = edges(detector, samples, time=10.0)
    assert (start.kind, end.kind) == (START, END)
    assert start.time == pytest.approx(11.5, abs=FRAME_S)
    assert end.time == pytest.approx(12.3, abs=2 * FRAME_S)
    assert start.index == pytest.approx((1.5 * RATE) % BLOCK, abs=FRAME_S * RATE)
    assert start.confidence > 0.7


def test_words_with_short_pauses_are_one_sound(detector, chance):
    samples = room(chance, 4.0)
    for word in range(5):
        put(samples, 1.0 + 0.3 * word, 0.2, noise(chance, "pink", RATE), 60.0)
    found = edges(detector, samples)
    assert [edge.kind for edge in found] == [START, END]
    assert found[1].time - found[0].time == pytest.approx(1.4, abs=3 * FRAME_S)


def test_a_click_is_heard(detector, chance):
    samples = room(chance, 3.0)
    put(samples, 1.0, 0.005, noise(chance, frames=RATE), 70.0)
    start, end = edges(detector, samples)
    assert start.time == pytest.approx(1.0, abs=FRAME_S)
    assert end.time - start.time < 3 * FRAME_S


@pytest.mark.parametrize("kind", ["white", "pink", "brown"])
@pytest.mark.parametrize("level_db", [30.0, 60.0])
def test_a_minute_of_steady_noise_is_no_sound(detector, chance, kind, level_db):
    assert edges(detector, room(chance, 60.0, level_db, kind)) == []


@pytest.mark.parametrize("kind", ["pink", "brown"])
def test_a_minute_of_noise_from_one_place_is_no_sound(detector, chance, kind):
    samples = np.repeat(noise(chance, kind, 60 * RATE)[:, None] * rms(55.0), 4, axis=1)
    assert edges(detector, samples + room(chance, 60.0)) == []


def test_silence_is_no_sound(detector):
    assert edges(detector, np.zeros((5 * RATE, 4))) == []


def test_a_noise_that_stays_becomes_background(detector, chance):
    samples = room(chance, 20.0)
    put(samples, 1.0, 19.0, noise(chance, frames=20 * RATE), 50.0)
    start, end = edges(detector, samples)
    assert start.time == pytest.approx(1.0, abs=FRAME_S)
    assert 3.0 < end.time < 15.0


def test_a_soft_sound_needs_a_sensitive_ear(chance):
    samples = room(chance, 3.0)
    put(samples, 1.0, 0.5, noise(chance, frames=RATE), 42.0)
    for sensitivity, count in ((1.0, 2), (0.9, 2), (0.5, 0), (0.0, 0)):
        detector = SoundDetector(RATE)
        detector.sensitivity = sensitivity
        assert len(edges(detector, samples)) == count, sensitivity


def test_blocks_of_any_length_give_the_same(chance):
    samples = room(chance, 3.0)
    put(samples, 1.0, 0.7, noise(chance, frames=RATE), 60.0)
    whole, pieces = SoundDetector(RATE), SoundDetector(RATE)
    expected = whole.feed(rounded(samples), 0.0)
    found = [
        edge
        for start in range(0, len(samples), 700)
        for edge in pieces.feed(rounded(samples[start : start + 700]), start / RATE)
    ]
    # The first floor is the mean of what there is at first, so the pieces know less of it.
    assert [edge.kind for edge in found] == [edge.kind for edge in expected]
    assert [edge.time for edge in found] == pytest.approx([edge.time for edge in expected], abs=FRAME_S)
