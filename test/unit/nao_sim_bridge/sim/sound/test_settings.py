from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.sound import settings
from nao_sim_bridge.sim.sound.settings import load_sound_settings


@pytest.fixture
def changed(change_file):
    """Reads the settings after a change of the file's content."""

    def read(change):
        change_file(settings, change)
        return load_sound_settings.__wrapped__()

    return read


def test_the_file_of_the_package_fits_the_robot():
    loaded = load_sound_settings()
    assert set(loaded.order) == {place.name for place in load_model().microphones}
    assert loaded.peak_of(loaded.microphone_full_scale_db) == 1.0


@pytest.mark.parametrize(
    "change, word",
    [
        (lambda c: c.update(loudness=3.0), "loudness"),
        (lambda c: c.pop("talk_db"), "talk_db"),
        (lambda c: c.update(speed_of_sound=0.0), "above 0"),
        (lambda c: c.update(background_db="quiet"), "not a number"),
        (lambda c: c["channels"].pop("rear"), "rear"),
        (lambda c: c["energies"].update(front=["MicroTop"]), "MicroTop"),
    ],
)
def test_a_wrong_file_is_refused_with_the_place(changed, change, word):
    with pytest.raises(ConfigError, match=word):
        changed(change)
