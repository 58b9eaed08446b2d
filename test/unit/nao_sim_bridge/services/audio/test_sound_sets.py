"""Sound sets: the one that is shipped, and those of clients."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.paths import data_root, sounds_directory
from nao_sim_bridge.services.audio.sound_sets import SoundSets
from nao_sim_bridge.services.errors import NaoqiError

SHIPPED = ["alarm", "applause", "bip", "chime", "click", "dance_100", "dance_120", "double_bip", "failure", "success"]


@pytest.fixture
def sets(tmp_path):
    own = tmp_path / "mine"
    own.mkdir()
    soundfile.write(str(own / "beep.wav"), np.full((480, 1), 0.5), 48000)
    (own / "notes.txt").write_text("no sound")
    return SoundSets(tmp_path, sounds_directory())


def test_the_shipped_set_has_sounds_that_can_be_heard(sets):
    sets.load("nao_library")
    for name in SHIPPED:
        sound = sets.sound(name)
        assert 0.05 < sound.duration < (25.0 if name.startswith("dance") else 2.5)
        assert 0.5 < np.abs(sound.samples).max() <= 1.0


def test_the_shipped_set_is_small():
    assert sum(path.stat().st_size for path in sounds_directory().rglob("*.ogg")) < 250_000


def test_sets_and_their_sounds_are_listed(sets):
    assert sets.installed() == ["mine", "nao_library"]
    assert sorted(sets.files("nao_library")) == SHIPPED
    assert list(sets.files("mine")) == ["beep"]
    assert sets.has("mine", "beep") and sets.has("mine", "beep.wav")
    assert not sets.has("mine", "notes") and not sets.has("yours", "beep")


def test_a_set_is_loaded_and_forgotten(sets):
    assert sets.loaded() == []
    sets.load("mine")
    sets.load("mine")
    assert sets.loaded() == ["mine"]
    sets.unload("mine")
    assert sets.loaded() == []
    with pytest.raises(NaoqiError, match="'mine' is not loaded; loaded are none"):
        sets.unload("mine")


def test_a_sound_comes_from_a_loaded_set_or_from_the_one_that_is_named(sets):
    with pytest.raises(NaoqiError, match="no sound set is loaded; installed are mine, nao_library"):
        sets.sound("beep")
    assert sets.sound("beep", "mine").frames == 480
    assert sets.loaded() == ["mine"]
    assert sets.sound("beep.wav").frames == 480
    with pytest.raises(NaoqiError, match="no sound 'bep'; there are mine/beep"):
        sets.sound("bep")


@pytest.mark.parametrize("name", ["nao_libary", "", "..", "mine/.."])
def test_unknown_sets_are_named(sets, name):
    with pytest.raises(NaoqiError, match=f"no sound set {name!r}; installed are mine, nao_library"):
        sets.load(name)


def test_the_shipped_sounds_are_those_of_the_tool(monkeypatch):
    monkeypatch.syspath_prepend(str(data_root() / "tools"))
    import make_sounds

    assert sorted(make_sounds.SOUNDS) == SHIPPED
    for name in SHIPPED:
        made = make_sounds.made(name)
        shipped, rate = soundfile.read(str(sounds_directory() / make_sounds.SET / f"{name}.ogg"))
        assert (rate, len(shipped)) == (make_sounds.RATE, len(made))
        np.testing.assert_array_equal(made, make_sounds.made(name))
