"""What microphones hear: the background, the own loudspeakers, files in place of the air."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE, Sound, sine
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.sound.settings import load_sound_settings


def rms(samples):
    return float(np.sqrt(np.mean(np.square(samples, dtype=float))))


def test_a_quiet_room_has_the_noise_that_the_settings_say(room):
    one = room(background_db=30.0)
    one.run(1.0)
    heard = one.frames(0.0, 1.0)
    assert 20 * math.log10(rms(heard) * math.sqrt(2.0)) == pytest.approx(30.0 - 104.0, abs=0.1)
    assert np.abs(np.corrcoef(heard) - np.eye(4)).max() < 0.02


def test_own_speech_has_the_level_of_the_loudspeakers(room):
    """Full scale is 80 dB at 1 m; microphones at 10 cm or less hear what is 20 dB more, from each of the two half."""
    one = room(near_field_m=1.0)
    one.loudspeakers.play(sine(100.0, 1.0), "say")
    one.run(0.5)
    for channel in one.frames(0.1, 0.4):
        assert 104.0 + 20 * math.log10(rms(channel) * math.sqrt(2.0)) == pytest.approx(80.0, abs=0.2)


def test_own_speech_arrives_after_the_way_from_the_loudspeaker(room):
    one = room(near_field_m=0.01)
    one.run(0.1)
    one.loudspeakers.play(Sound(np.r_[1.0, np.zeros(1999)].astype(np.float32)), "play", pan=-1.0)
    one.run(0.1)
    speaker = np.asarray(one.model.loudspeakers[0].position)
    for channel, place in zip(one.frames(0.1, 0.15), one.world.microphones.places):
        assert np.argmax(np.abs(channel)) == pytest.approx(np.linalg.norm(place - speaker) / 343.0 * RATE, abs=0.51)


def test_a_file_takes_the_place_of_the_air_and_the_past_stays(room):
    one = room(background_db=30.0)
    one.run(0.5)
    before = one.frames(0.0, 0.4).copy()
    rising = np.linspace(0.0, 0.5, RATE // 10, dtype=np.float32)
    one.microphones.replaced_by = Sound(rising)
    one.run(0.5)
    assert np.array_equal(one.frames(0.0, 0.4), before)
    heard = one.frames(0.5, 0.9)
    assert heard[3, : RATE // 10] == pytest.approx(rising, abs=1e-6)
    assert one.microphones.replaced_by is None
    assert rms(heard[:, RATE // 10 :]) == pytest.approx(rms(before), rel=0.05)  # it is over
    with pytest.raises(BadValue, match="1 or 2 .* or 4"):
        one.microphones.replaced_by = Sound(np.zeros((5, 3)))


def test_the_settings_of_the_package_fit_the_robot():
    loaded = load_sound_settings()
    assert set(loaded.order) == {place.name for place in load_model().microphones}
    assert loaded.peak_of(loaded.microphone_full_scale_db) == 1.0
    sides = {name: loaded.energy_channels(name) for name in loaded.energies}
    assert sides == {"left": (0, 2), "right": (1, 3), "front": (2, 3), "rear": (0, 1)}
