"""Recognition and localisation over many words, noises and directions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from amount import part_of
from ear_sounds import BLOCK, PLACES, RATE, background, harmonics, heard, noise, rms, rounded
from spoken_words import LEVEL, blocks, in_a_room, spoken
from spoken_words import RATE as SPEECH_RATE

from nao_sim_bridge.hearing.detection import SoundDetector
from nao_sim_bridge.hearing.grammars.grammar import vocabulary
from nao_sim_bridge.hearing.listening import Listening, Recognised
from nao_sim_bridge.hearing.localisation import direction, microphone_array
from nao_sim_bridge.hearing.localiser import Localiser
from nao_sim_bridge.hearing.worker import Ear

ARRAY = microphone_array(PLACES)
WAVES = {"white": noise, "pink": lambda chance: noise(chance, "pink"), "harmonics": harmonics}
VOCABULARY = [
    *("yes", "no", "hello", "goodbye", "stop", "one", "two", "three", "four", "five"),
    *("red", "green", "blue", "left", "right", "stand up", "sit down", "good morning", "come here", "thank you"),
    *("what is your name", "play music", "turn around", "yellow", "follow me", "open your hand", "look at me"),
    *("wave", "tell me a story", "help"),
]


@pytest.fixture(scope="module")
def ear():
    return Ear()


@pytest.fixture
def found(ear):
    """Phrases that the ear finds in a stream, one list an utterance."""

    def find(stream, phrases=VOCABULARY, **options):
        ear.listen(Listening((vocabulary("v", list(phrases), **options),)))
        ear.finish(None)
        events = [event for block in blocks(stream) for event in ear.hear(block)]
        return [[h.phrase for h in e.hypotheses] for e in events if isinstance(e, Recognised)]

    return find


@pytest.mark.parametrize("part", part_of(range(6), 4))
def test_most_of_thirty_phrases_are_understood(found, part):
    said = VOCABULARY[part::6]
    voice, noise_db = ("slt", -35.0) if part % 2 else ("awb", -20.0)
    stream = in_a_room(*(spoken(phrase, voice) for phrase in said), noise=LEVEL * 10.0 ** (noise_db / 20.0))
    heard_phrases = [phrases[:1] for phrases in found(stream)]
    assert sum([phrase] == phrases for phrase, phrases in zip(said, heard_phrases)) >= 4, heard_phrases


@pytest.mark.parametrize("text", ["she plays the violin every day", "this box is very heavy", "the river is deep"])
@pytest.mark.parametrize("spotting", [False, True])
def test_nothing_is_found_in_other_speech(found, text, spotting):
    phrases = ["yes", "no", "Stand up!", "room 21", "good morning", "red", "what is your name"]
    assert found(in_a_room(spoken(text, "awb")), phrases, word_spotting=spotting) == [[]]


@pytest.mark.parametrize("sound", ["silence", "noise", "tones", "hum", "clicks"])
def test_what_is_no_speech_is_not_recognised(found, sound):
    times = np.arange(8 * SPEECH_RATE) / SPEECH_RATE
    gate = times % 1.6 < 0.7
    wave = {
        "silence": 0.0 * times,
        "noise": np.random.default_rng(5).standard_normal(len(times)),
        "tones": np.sin(2.0 * np.pi * 440.0 * times) * gate,
        "hum": sum(np.sin(2.0 * np.pi * 150.0 * k * times) / k for k in range(1, 9)) * gate,
        "clicks": 20.0 * (np.arange(len(times)) % 9000 < 40),
    }[sound]
    assert [phrases for phrases in found(in_a_room(LEVEL * wave)) if phrases] == []


@pytest.mark.parametrize("kind", WAVES)
@pytest.mark.parametrize("noise_db", part_of([-20.0, 30.0], 2), ids="{:g} dB".format)
@pytest.mark.parametrize("elevation", part_of([15.0, 0.0], 2))
def test_azimuths_are_right_within_3_degrees_mostly_and_10_always(kind, noise_db, elevation):
    """For sources all around at 1 to 3 m."""
    chance, off, count = np.random.default_rng(11), [], 24
    for index in range(count):
        azimuth = -180.0 + 360.0 * (index + 0.5) / count
        toward, distance = direction(math.radians(azimuth), math.radians(elevation)), chance.uniform(1.0, 3.0)
        own = noise_db if noise_db > 0.0 else 65.0 - 20.0 * math.log10(distance) + noise_db
        samples = rounded(heard(WAVES[kind](chance), toward, distance) + background(chance, own))
        located = Localiser(ARRAY, RATE).feed(samples, 0.0)
        assert located is not None, azimuth
        off.append(abs((math.degrees(located.azimuth) - azimuth + 180.0) % 360.0 - 180.0))
    off = np.array(off)
    assert np.median(off) < 1.0 and np.mean(off < 3.0) >= 0.8 and np.mean(off < 10.0) >= 0.95


@pytest.mark.parametrize(
    "kind, level_db, together",
    [
        ("white", 60.0, False),
        ("pink", 30.0, False),
        ("brown", 60.0, False),
        ("pink", 55.0, True),
        ("brown", 55.0, True),
    ],
)
def test_a_minute_of_steady_noise_is_no_sound(kind, level_db, together):
    """Of the microphones alone, or from one place."""
    chance, detector = np.random.default_rng(5), SoundDetector(RATE)
    frames = 60 * RATE // BLOCK * BLOCK
    samples = background(chance, 30.0 if together else level_db, frames, kind)
    if together:
        samples += (noise(chance, kind, frames) * rms(level_db))[:, None]
    blocks_of = rounded(samples).reshape(-1, BLOCK, 4)
    assert [edge for number, block in enumerate(blocks_of) for edge in detector.feed(block, number * 0.17)] == []
