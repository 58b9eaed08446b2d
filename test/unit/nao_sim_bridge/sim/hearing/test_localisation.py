"""Sounds are found where they are; noise from nowhere, silence and the own voice are not."""

from __future__ import annotations

import math

import numpy as np
import pytest
from ear_sounds import BLOCK, PLACES, RATE, background, harmonics, heard, noise, rounded

from nao_sim_bridge.sim.hearing.array import direction, microphone_array
from nao_sim_bridge.sim.hearing.localisation import DirectionFinder
from nao_sim_bridge.sim.hearing.localiser import Localiser
from nao_sim_bridge.sim.hearing.spectra import cross_spectra, short_spectra

ARRAY = microphone_array(PLACES)
WAVES = {
    "white": noise,
    "pink": lambda chance: noise(chance, "pink"),
    "harmonics": harmonics,
}
BLOCK_S = BLOCK / RATE


@pytest.fixture
def localiser():
    return Localiser(ARRAY, RATE)


@pytest.fixture
def chance():
    return np.random.default_rng(11)


def wrapped(degrees):
    return (degrees + 180.0) % 360.0 - 180.0


def misses(chance, kind, elevation, noise_db, count=24):
    """How far off azimuths are, degrees, for sources all around at 1 to 3 m."""
    off = []
    for index in range(count):
        azimuth = -180.0 + 360.0 * (index + 0.5) / count
        toward = direction(math.radians(azimuth), math.radians(elevation))
        distance = chance.uniform(1.0, 3.0)
        own = noise_db if noise_db > 0.0 else 65.0 - 20.0 * math.log10(distance) + noise_db
        samples = rounded(heard(WAVES[kind](chance), toward, distance) + background(chance, own))
        found = Localiser(ARRAY, RATE).feed(samples, 0.0)
        assert found is not None, azimuth
        off.append(abs(wrapped(math.degrees(found.azimuth) - azimuth)))
    return np.array(off)


@pytest.mark.parametrize("kind", WAVES)
@pytest.mark.parametrize("noise_db", [30.0, -20.0], ids=["quiet room", "20 dB SNR"])
@pytest.mark.parametrize("elevation", [0.0, 15.0])
def test_azimuths_are_right_within_3_degrees_mostly_and_10_always(chance, kind, noise_db, elevation):
    off = misses(chance, kind, elevation, noise_db)
    assert np.median(off) < 1.0
    assert np.mean(off < 3.0) >= 0.8
    assert np.mean(off < 10.0) >= 0.95


@pytest.mark.parametrize("azimuth, elevation", [(0, 0), (0, -20), (30, 10), (-120, 0), (180, 25), (150, -10)])
def test_elevations_are_right_where_the_geometry_tells(chance, localiser, azimuth, elevation):
    toward = direction(math.radians(azimuth), math.radians(elevation))
    found = localiser.feed(rounded(heard(noise(chance), toward) + background(chance)), 0.0)
    assert math.degrees(found.elevation) == pytest.approx(elevation, abs=3.0)
    assert wrapped(math.degrees(found.azimuth) - azimuth) == pytest.approx(0.0, abs=2.0)


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
    assert clear.confidence > 0.95
    assert 0.3 <= noisy.confidence < clear.confidence


def test_energy_is_the_root_mean_square(chance, localiser):
    samples = rounded(heard(noise(chance), direction(0.5, 0.0)) + background(chance))
    found = localiser.feed(samples, 3.5)
    assert found.energy == pytest.approx(np.sqrt(np.mean(samples.astype(float) ** 2)), rel=1e-3)
    assert found.time == 3.5


@pytest.mark.parametrize("kind", ["white", "pink", "brown"])
@pytest.mark.parametrize("level_db", [30.0, 60.0, 90.0])
def test_noise_from_nowhere_is_not_located(chance, localiser, kind, level_db):
    for number in range(10):
        samples = rounded(background(chance, level_db, kind=kind))
        assert localiser.feed(samples, number * BLOCK_S) is None


def test_silence_is_not_located(localiser):
    assert localiser.feed(np.zeros((BLOCK, 4), np.int16), 0.0) is None


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


def test_the_own_voice_is_nobody_else(chance, localiser):
    samples = rounded(heard(noise(chance), direction(0.5, 0.0)) + background(chance))
    power = float(np.mean(samples.astype(float) ** 2))
    assert localiser.feed(samples, 0.0, own_power=lambda: 0.5 * power) is None
    assert localiser.feed(samples, BLOCK_S, own_power=lambda: 0.02 * power) is not None


def test_a_less_sensitive_ear_needs_more(chance):
    samples = rounded(heard(noise(chance), direction(0.5, 0.0), level_db=52.0) + background(chance))
    dull = Localiser(ARRAY, RATE)
    dull.sensitivity = 0.2
    assert dull.feed(samples, 0.0) is None
    assert Localiser(ARRAY, RATE).feed(samples, 0.0) is not None


@pytest.mark.parametrize("lateral", [0.999, 1.0, 1.08])
def test_a_shadow_at_the_rim_and_beyond_is_a_direction_in_the_plane(lateral):
    found = DirectionFinder(ARRAY, RATE).direction_of(np.array([0.0, lateral]))
    assert np.linalg.norm(found) == pytest.approx(1.0)
    assert math.degrees(math.atan2(found[1], found[0])) == pytest.approx(90.0, abs=3.0)
    assert math.degrees(math.asin(found[2])) == pytest.approx(0.0, abs=5.0)


def test_noise_of_the_microphones_is_told_from_what_they_share(chance):
    source = heard(noise(chance), direction(1.0, 0.0), level_db=70.0)
    spectra = cross_spectra(short_spectra(rounded(source + background(chance, 50.0)), RATE))
    alone = cross_spectra(short_spectra(rounded(background(chance, 50.0)), RATE))
    assert np.median(spectra.noise) == pytest.approx(np.median(alone.power), rel=0.4)
    assert np.median(spectra.power) > 5.0 * np.median(spectra.noise)
