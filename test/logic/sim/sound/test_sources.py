"""Sources of sound in a room: levels, delays, movement; heard by the microphones of the head."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE, Sound, sine
from nao_sim_bridge.base.sizes import WorldSoundSizes, load_sizes
from nao_sim_bridge.sound import sources
from nao_sim_bridge.sound.sources import SoundSource

TONE = sine(1000.0, 10.0, 0.3)
NOISE = Sound(np.random.default_rng(1).normal(0.0, 0.1, 10 * RATE).astype(np.float32))


def level(samples):
    """dB SPL of what a microphone heard."""
    return 104.0 + 20 * math.log10(np.sqrt(np.mean(np.square(samples, dtype=float))) * math.sqrt(2.0))


def at_distance(room, distance, bearing=0.0):
    """A place so far from the point between the four microphones, m."""
    microphones = room.world.microphones
    x, y, z = microphones.poses.at(0, 0).place(microphones.places)[0].mean(axis=0)
    return (x + distance * math.cos(bearing), y + distance * math.sin(bearing), z)


@pytest.fixture
def sounding(room):
    """A room in which "it" sounds at a distance in m."""

    def make(sound, distance=1.0, bearing=0.0, air=None, **options):
        one = room(**(air or {}))
        one.sources.add(SoundSource("it", at_distance(one, distance, bearing), sound, **options))
        return one

    return make


@pytest.mark.parametrize("distance", [0.5, 2.0, 8.0])
@pytest.mark.parametrize("sound", [TONE, NOISE], ids=["tone", "noise"])
def test_sound_gets_weaker_with_distance(sounding, distance, sound):
    one = sounding(sound, distance, level_db=65.0, loop=True)
    one.run(1.0)
    # White noise loses 0.3 dB, all of it above 16 kHz.
    expected = pytest.approx(65.0 - 20.0 * math.log10(distance), abs=0.35 if sound is NOISE else 0.1)
    assert level(one.frames(0.3, 1.0)) == expected


@pytest.mark.parametrize("bearing", np.radians([0, 90, 135, -60, -150]))
def test_delays_between_microphones_are_those_of_the_geometry(sounding, bearing):
    """Right within a hundredth of a millisecond, measured by the phase of the cross spectrum."""
    one = sounding(NOISE, 1.5, bearing, air={"near_field_m": 0.01})
    one.run(1.0)
    heard, microphones = one.frames(0.2, 0.9), one.world.microphones
    ways = microphones.poses.at(0, 0).place(microphones.places)[0] - np.array(at_distance(one, 1.5, bearing))
    distances = np.linalg.norm(ways, axis=1)
    spectra = np.fft.rfft(heard * np.hanning(heard.shape[1]))
    frequencies = np.fft.rfftfreq(heard.shape[1], 1.0 / RATE)
    use = (frequencies > 200) & (frequencies < 1000)  # low enough that phases do not wrap
    for k in range(1, 4):
        phases = np.angle(spectra[k, use] * np.conj(spectra[0, use]))
        delay = -np.sum(phases * frequencies[use]) / np.sum(2 * np.pi * frequencies[use] ** 2)
        assert delay == pytest.approx((distances[k] - distances[0]) / 343.0, abs=1e-5)


def test_a_level_is_that_of_the_sound_and_not_of_its_pauses_and_has_a_volume(sounding):
    half = Sound(np.concatenate([NOISE.samples[:RATE, 0], np.zeros(RATE, np.float32)]))
    one = sounding(half, level_db=70.0)
    one.run(0.5)
    one.sources.get("it").set_volume(0.1)
    one.run(0.5)
    assert level(one.frames(0.2, 0.45)) == pytest.approx(70.0, abs=0.3)
    assert level(one.frames(0.6, 0.95)) == pytest.approx(50.0, abs=0.3)


def test_a_moving_source_does_not_click(sounding):
    """Steps of 5 cm, and one across the room, in a low tone: whatever clicks stands out at high frequencies."""
    one = sounding(sine(200.0, 10.0, 0.5), level_db=80.0)
    one.run(0.5)
    for step in range(10):
        one.sources.move("it", at_distance(one, 1.0 + 0.05 * step))
        one.run(0.05)
    one.sources.move("it", at_distance(one, 3.0, 2.0))
    one.run(0.5)
    heard = one.frames(0.2, 1.4)[0]
    # This weakens 200 Hz by 95 dB and a step not at all: 5 cm at once would be a step of a tenth and more.
    assert np.abs(np.diff(heard, 3)).max() < 5e-3 * np.abs(heard).max()
    assert level(one.frames(1.2, 1.4)) == pytest.approx(80.0 - 20 * math.log10(3.0), abs=0.3)


def test_a_source_that_comes_nearer_sounds_higher(sounding):
    one = sounding(sine(1000.0, 3.0, 0.5), 6.0, level_db=80.0)
    one.moves = lambda time: one.sources.move("it", at_distance(one, 6.0 - 3.43 * time))
    one.run(1.3)
    heard = one.frames(0.2, 1.2)[0]
    spectrum = np.abs(np.fft.rfft(heard * np.hanning(len(heard))))
    assert np.argmax(spectrum) == pytest.approx(1000.0 / (1.0 - 0.01), abs=1.5)


def test_sources_have_a_budget_together(sounding, monkeypatch):
    two_seconds = WorldSoundSizes(2 * RATE * 4, sounds=64)
    monkeypatch.setattr(sources, "load_sizes", lambda: replace(load_sizes(), world_sounds=two_seconds))
    room = sounding(sine(1000.0, 1.5))
    with pytest.raises(BadValue, match="sound is '192000 bytes', allowed is 384000 bytes for all sources"):
        room.sources.add(SoundSource("more", (1.0, 0.0, 0.0), sine(500.0, 1.0)))
    assert room.sources.names() == ["it"]
