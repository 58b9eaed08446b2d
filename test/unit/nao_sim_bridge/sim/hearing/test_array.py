"""Geometry of the four microphones: lags between them and directions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from ear_sounds import PLACES, SPEED

from nao_sim_bridge.sim.hearing.array import DISTANCE, direction, microphone_array
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.sound.settings import load_sound_settings


@pytest.fixture(scope="module")
def array():
    return microphone_array(PLACES)


def test_these_are_the_microphones_of_the_robot():
    by_name = {place.name: place.position for place in load_model("V6").microphones}
    assert [by_name[name].tolist() for name in load_sound_settings().order] == PLACES.tolist()


def test_directions_are_counted_from_ahead_to_the_left_and_upwards():
    assert direction(0.0, 0.0) == pytest.approx([1.0, 0.0, 0.0])
    assert direction(math.pi / 2, 0.0) == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)
    assert direction(0.3, math.pi / 2) == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)


def test_the_microphones_lie_in_a_plane_that_is_tilted_forward(array):
    ahead, left, normal = array.axes
    assert np.abs(array.places @ normal).max() < 1e-6
    assert math.degrees(math.asin(ahead[2])) == pytest.approx(26.6, abs=0.1)
    assert left == pytest.approx([0.0, 1.0, 0.0], abs=1e-4)
    assert normal[2] > 0.8


@pytest.mark.parametrize("azimuth", range(-180, 180, 40))
@pytest.mark.parametrize("elevation", [-20, 0, 45])
def test_lags_are_those_of_a_source_at_the_distance_that_is_assumed(array, azimuth, elevation):
    toward = direction(math.radians(azimuth), math.radians(elevation))
    ways = np.linalg.norm(PLACES - PLACES.mean(axis=0) - DISTANCE * toward, axis=1) / SPEED
    expected = ways[array.pairs[:, 1]] - ways[array.pairs[:, 0]]
    # A hundredth of a sample at 48 kHz is 0.2 us.
    assert array.lags(array.shadow(toward)) == pytest.approx(expected, abs=0.2e-6)


def test_a_direction_and_its_mirror_image_cannot_be_told_apart(array):
    ahead = direction(0.0, 0.0)
    mirrored = ahead - 2.0 * (ahead @ array.axes[2]) * array.axes[2]
    assert math.degrees(math.asin(mirrored[2])) == pytest.approx(53.3, abs=0.2)
    assert array.lags(array.shadow(mirrored)) == pytest.approx(array.lags(array.shadow(ahead)), abs=1e-12)
