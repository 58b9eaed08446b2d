"""Sounds of world files: read strictly, made right, and begun when and where they should be."""

from __future__ import annotations

import numpy as np
import pybullet
import pytest
import yaml

from nao_sim_bridge.sim.sound.files import write_sound
from nao_sim_bridge.sim.sound.samples import RATE, Sound, sine
from nao_sim_bridge.sim.world import WorldError, load_world
from nao_sim_bridge.sim.world_reader import read_world
from nao_sim_bridge.sim.world_sounds_made import make_sound, noise, tone
from nao_sim_bridge.sim.world_sounds_playing import WorldSounds

BALL = {"name": "ball", "sphere": 0.05, "position": [1.0, 0.5, 0.05], "mass": 0.05}
TABLE = {"name": "table", "box": [0.4, 0.4, 0.4], "position": [1.0, -1.0, 0.2], "rpy": [0, 0, 1.5707963]}
HUM = {"name": "hum", "tone": 100, "position": [1, 2, 3]}


def spoken(text, voice):
    """Stands for a voice: as long as the text."""
    return sine(300.0, 0.1 * len(text), 0.5)


def world_of(*sounds, folder=None):
    content = {"floor": {"friction": 1.0}, "objects": [BALL, TABLE], "sounds": list(sounds)}
    return read_world(content, "test", "test.yaml", folder)


def sound_of(entry, folder=None):
    (sound,) = world_of(entry, folder=folder).sounds
    return make_sound(sound, spoken)


# --- read -------------------------------------------------------------------------------------------------------------


def test_a_sound_has_sensible_defaults():
    (hum,) = world_of(HUM).sounds
    assert (hum.kind, hum.content, hum.position, hum.on) == ("tone", (100.0,), (1.0, 2.0, 3.0), None)
    assert (hum.level_db, hum.start, hum.loop, hum.pause, hum.duration) == (65.0, 0.0, False, 0.0, None)


def test_a_world_may_be_silent():
    assert load_world("empty").sounds == ()
    assert load_world("lab").sounds == ()


def test_the_party_has_a_person_a_radio_and_a_fan():
    kinds = {sound.name: sound.kind for sound in load_world("party").sounds}
    assert kinds["anna"] == "say" and kinds["fan"] == "noise" and kinds["radio_1"] == "tone"


def test_on_may_be_written_without_quotes(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(
        "floor: {friction: 1}\nobjects:\n- {name: ball, sphere: 0.1, position: [1, 0, 1]}\n"
        "sounds:\n- {name: bell, on: ball, tone: 440}\n"
    )
    (bell,) = load_world(str(path)).sounds
    assert bell.on == "ball"


@pytest.mark.parametrize(
    "entry, message",
    [
        ("loud", "is 'loud', not a mapping"),
        ({**HUM, "levl_db": 3}, "unknown key 'levl_db', did you mean 'level_db'"),
        ({"tone": 100, "position": [1, 2, 3]}, "missing 'name'"),
        ({**HUM, "name": ""}, "name: is '', not a name"),
        ({"name": "hum", "tone": 100}, "missing 'position', or 'on'"),
        ({"name": "hum", "position": [0, 0, 1]}, "has nothing to sound, needs exactly one of file, tone, noise, say"),
        ({**HUM, "noise": "white"}, "has tone and noise to sound"),
        ({**HUM, "position": [1, 2]}, "not 3 finite numbers"),
        (
            {"name": "hum", "on": "dog", "tone": 100},
            r"on: is 'dog', allowed is an object of this world \(ball, table\)",
        ),
        ({**HUM, "tone": -5}, "tone: is -5, allowed is above 0 to 20000 Hz"),
        ({**HUM, "tone": []}, "tone"),
        ({**HUM, "tone": "A4"}, "tone: .*not"),
        ({"name": "n", "noise": "blue", "position": [0, 0, 1]}, "noise: is 'blue', allowed is white or pink"),
        ({"name": "n", "say": " ", "position": [0, 0, 1]}, "say: is ' ', not a text"),
        ({**HUM, "voice": "slt"}, "voice: is for a text to say"),
        ({**HUM, "loop": "yes please"}, "loop: is 'yes please', allowed is true or false"),
        ({**HUM, "pause": 1.0}, "pause: is for what is repeated"),
        ({**HUM, "start": -1}, "start: is -1, allowed is 0 or more"),
        ({**HUM, "level_db": 200}, r"level_db: is 200, allowed is -20\.\.140"),
        ({"name": "n", "say": "hi", "position": [0, 0, 1], "duration": 2}, "duration: is for tones and noises"),
        ({**HUM, "duration": 0}, "duration: is 0"),
        ({"name": "n", "file": "a.wav", "position": [0, 0, 1]}, "file: a world without a file"),
    ],
)
def test_what_is_wrong_is_said(entry, message):
    with pytest.raises(WorldError, match=message) as raised:
        world_of(entry)
    assert str(raised.value).startswith("test.yaml: sounds[0]")


def test_names_are_unique():
    with pytest.raises(WorldError, match=r"sounds\[1\]\.name: 'hum' is taken"):
        world_of(HUM, HUM)


@pytest.mark.parametrize(
    "name, message",
    [
        ("../a.wav", "allowed is a name inside"),
        ("/a.wav", "allowed is a name inside"),
        ("b.wav", "there is no file 'b.wav'"),
    ],
)
def test_files_are_beside_the_world_file(tmp_path, name, message):
    (tmp_path / "world").mkdir()
    (tmp_path / "a.wav").touch()
    with pytest.raises(WorldError, match=message):
        world_of({"name": "n", "file": name, "position": [0, 0, 1]}, folder=tmp_path / "world")


# --- made -------------------------------------------------------------------------------------------------------------


def spectrum(sound):
    values = np.abs(np.fft.rfft(sound.samples[:, 0]))
    return np.fft.rfftfreq(sound.frames, 1.0 / sound.rate), values


def test_tones_have_their_frequencies():
    frequencies, values = spectrum(sound_of({**HUM, "tone": [440.0, 1000.0]}))
    assert sorted(frequencies[np.argsort(values)[-2:]]) == pytest.approx([440.0, 1000.0], abs=0.1)


@pytest.mark.parametrize("made", [tone([123.4]), noise("white"), noise("pink", seed=3)])
def test_what_does_not_end_repeats_without_a_seam(made):
    wave = made.samples[:, 0]
    assert abs(wave[0] - wave[-1]) <= np.abs(np.diff(wave)).max()
    assert 0.05 < np.sqrt(np.mean(wave**2)) and np.abs(wave).max() < 1.0


def test_pink_noise_has_as_much_in_every_octave():
    frequencies, values = spectrum(noise("pink"))
    powers = [np.sum(values[(frequencies >= low) & (frequencies < 2 * low)] ** 2) for low in (100, 400, 1600, 6400)]
    assert max(powers) < 1.2 * min(powers)


def test_sounds_of_one_seed_are_equal_and_of_others_not():
    assert np.array_equal(noise("white", 0.1, seed=1).samples, noise("white", 0.1, seed=1).samples)
    assert not np.array_equal(noise("white", 0.1, seed=1).samples, noise("white", 0.1, seed=2).samples)


def test_files_texts_and_pauses_have_their_lengths(tmp_path):
    write_sound(tmp_path / "a.wav", Sound(np.zeros((4410, 2), np.float32) + 0.1, 44100))
    assert sound_of({"name": "n", "file": "a.wav", "position": [0, 0, 1]}, tmp_path).duration == pytest.approx(0.1)
    assert sound_of({"name": "n", "say": "Hello", "position": [0, 0, 1]}).duration == pytest.approx(0.5)
    burst = sound_of({**HUM, "duration": 0.2, "loop": True, "pause": 0.3})
    assert burst.duration == pytest.approx(0.5)
    assert np.all(burst.samples[round(0.2 * RATE) :] == 0.0)


# --- playing ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def playing(bench, tmp_path):
    """A simulation of a world with these sounds, which have begun."""

    def make(*sounds):
        path = tmp_path / "world.yaml"
        path.write_text(yaml.safe_dump({"floor": {"friction": 1.0}, "objects": [BALL, TABLE], "sounds": list(sounds)}))
        one = bench(world=str(path))
        WorldSounds(one.simulation, load_world(str(path)), spoken).begin()
        return one

    return make


def names(one):
    return one.simulation.sound.sources.names()


def test_sounds_begin_when_they_are_due_and_end(playing):
    burst = {"name": "burst", "noise": "white", "position": [1, 0, 1], "start": 0.3, "duration": 0.2}
    one = playing(HUM, burst)
    assert names(one) == ["hum"]
    one.run(0.28)
    assert names(one) == ["hum"]
    one.run(0.06)
    assert names(one) == ["hum", "burst"]
    one.run(0.2)
    assert names(one) == ["hum"]


def test_a_reset_begins_again(playing):
    one = playing({"name": "late", "say": "Hi", "position": [1, 0, 1], "start": 0.2})
    one.run(0.5)
    assert names(one) == []
    one.simulation.reset()
    one.run(0.1)
    assert names(one) == []
    one.run(0.15)
    assert names(one) == ["late"]


def test_a_sound_rides_on_what_moves(playing):
    one = playing({"name": "bell", "on": "ball", "tone": 500, "position": [0, 0, 0.1]})
    physics = one.simulation._physics
    pybullet.resetBaseVelocity(physics.bodies.ids["ball"], (1.0, 0.0, 0.0), physicsClientId=physics.client)
    one.run(0.5)
    ball = one.now.objects["ball"].position
    place = one.simulation.sound.sources.get("bell").place
    assert ball[0] > 1.2
    assert np.linalg.norm(np.subtract(place, ball)) == pytest.approx(0.1, abs=0.03)


def test_a_sound_stands_on_what_does_not_move_and_is_turned_with_it(playing):
    one = playing({"name": "radio", "on": "table", "tone": 500, "position": [0.1, 0, 0.2]})
    assert one.simulation.sound.sources.get("radio").place == pytest.approx((1.0, -0.9, 0.4), abs=1e-6)


def test_what_cannot_be_made_names_its_sound(bench, tmp_path):
    (tmp_path / "noise.wav").write_text("this is no sound")
    (tmp_path / "world.yaml").write_text(
        "floor: {friction: 1}\nsounds:\n- {name: radio, file: noise.wav, position: [1, 0, 1]}\n"
    )
    path = str(tmp_path / "world.yaml")
    with pytest.raises(WorldError, match="world world: sound 'radio': .*cannot be read"):
        WorldSounds(bench(world=path).simulation, load_world(path), spoken)


def test_it_is_heard_as_loud_as_it_should_be(playing):
    one = playing({"name": "n", "noise": "white", "position": [0, 2, 0.45], "level_db": 70})
    one.run(1.0)
    heard = one.simulation.sound.microphones.heard(0.5, 0.9)
    level = 20 * np.log10(np.sqrt(np.mean(heard**2)) * np.sqrt(2.0)) + 104.0
    assert level == pytest.approx(70 - 6.0, abs=1.0)
