"""Where speech begins and ends, what is noise, and what speaks for a phrase; for sounds made by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from spoken_words import blocks

from nao_sim_bridge.hearing.evidence import Evidence, Piece, difference, distance, evidence, score_within, words_within
from nao_sim_bridge.hearing.noise_reduction import FRAME, noise_spectrum, reduce_noise
from nao_sim_bridge.hearing.settings import ConfidenceSettings, load_recognition
from nao_sim_bridge.hearing.speech_likeness import likeness
from nao_sim_bridge.hearing.voice_activity import RATE, SpeechChange, Utterance, VoiceActivity

TIMES = np.arange(RATE) / RATE


def stream(*parts, seed=1):
    """Parts (seconds, level of noise in the band of speech, dB below full scale) one after the other; int16."""
    random = np.random.default_rng(seed)
    sound = [random.standard_normal(round(s * RATE)) * 10.0 ** (db / 20.0) for s, db in parts]
    return np.round(np.clip(np.concatenate(sound), -1.0, 1.0) * 32767.0).astype(np.int16)


def heard(sound, sensitivity=0.5, begin=0.0):
    activity = VoiceActivity(load_recognition(), sensitivity)
    return [event for time, samples in blocks(sound) for event in activity.hear(begin + time, samples)]


def utterances(events):
    return [event for event in events if isinstance(event, Utterance)]


def test_speech_is_cut_out_with_its_times():
    begin, end, found = heard(stream((2.0, -74.0), (0.8, -40.0), (1.5, -74.0)), begin=100.0)
    assert (type(begin), type(end), type(found)) == (SpeechChange, SpeechChange, Utterance)
    assert (begin.present, end.present) == (True, False)
    assert begin.time == pytest.approx(102.0, abs=0.1) and end.time == pytest.approx(102.8, abs=0.05)
    assert (found.start, found.end) == (begin.time, end.time)
    assert 0.8 + 0.2 < len(found.samples) / RATE < 0.8 + 0.8
    assert 20.0 * np.log10(np.std(found.background)) == pytest.approx(-74.0, abs=1.0)


@pytest.mark.parametrize("pause, count", [(0.3, 1), (0.7, 2)])
def test_a_short_pause_belongs_to_the_utterance_and_a_long_one_ends_it(pause, count):
    sound = stream((2.0, -74.0), (0.5, -40.0), (pause, -74.0), (0.5, -40.0), (1.0, -74.0))
    assert len(utterances(heard(sound))) == count


@pytest.mark.parametrize("parts", [[(5.0, -74.0)], [(2.0, -74.0), (0.02, -30.0), (2.0, -74.0)], [(6.0, -45.0)]])
def test_silence_clicks_and_steady_noise_are_no_utterance(parts):
    assert utterances(heard(stream(*parts))) == []


def noise(seconds, seed):
    return 0.01 * np.random.default_rng(seed).standard_normal(round(seconds * RATE)).astype(np.float32)


def level(samples):
    return 10.0 * np.log10(np.mean(np.square(samples, dtype=float)))


LEARNT = noise_spectrum(noise(1.0, 1))


def test_steady_noise_is_lowered_to_about_the_least_gain_and_a_loud_tone_stays():
    alone = noise(1.0, 2)
    assert level(alone) - level(reduce_noise(alone, LEARNT, 0.25, 0.96)) == pytest.approx(12.04, abs=1.5)
    tone = 0.3 * np.sin(2.0 * np.pi * 1000.0 * TIMES)
    found = reduce_noise(tone + alone, LEARNT, 0.25, 0.96)
    inside = slice(2 * FRAME, -2 * FRAME)
    assert level(found[inside] - tone[inside]) < level(alone) - 6.0


SETTINGS = ConfidenceSettings(bias=0.0, difference=3.0, everyday=1.0, sounds=1.0, same=1.0, length=1.0, least=0.4)


def word(text, phones, start, end, score):
    return Piece(text, tuple(phones.split()), start, end, score)


EVERYDAY = [
    Piece("<s>", (), 0, 9, -10.0),
    word("we", "W IY", 10, 19, -20.0),
    word("stand", "S T AE N D", 20, 39, -60.0),
    word("up", "AH P", 40, 49, -20.0),
]
SOUNDS = [Piece("S", ("S",), 0, 49, -50.0)]
STAND_UP = [word("stand-0", "S T AE N D", 20, 39, -60.0), word("up-1", "AH P", 40, 49, -20.0)]


def test_a_phrase_that_was_written_down_has_nothing_against_it():
    found = evidence(STAND_UP, ["stand", "up"], EVERYDAY, SOUNDS, inside=True)
    assert found.same and found.difference == 0.0 and found.everyday == pytest.approx(0.0)
    assert found.sounds == pytest.approx((-80.0 + 30.0) / 30) and found.length == pytest.approx(7 / 9)
    whole = evidence(STAND_UP, ["stand", "up"], EVERYDAY, SOUNDS)  # here the other words count
    assert not whole.same and whole.difference == pytest.approx(2 / 7)


def test_a_phrase_that_sounds_different_says_so_within_bounds():
    found = evidence([word("no-0", "N OW", 20, 39, -100.0)], ["no"], EVERYDAY, SOUNDS, inside=True)
    assert not found.same and found.difference == 1.0 and found.everyday == pytest.approx(-40.0 / 20)
    found = evidence([word("no-0", "N OW", 20, 39, -1e6)], ["no"], [], SOUNDS)
    assert (found.difference, found.everyday, found.sounds) == (1.0, -2.0, -5.0)
    assert evidence([word("no-0", "N OW", 0, 49, -1.0)], ["no"], EVERYDAY, SOUNDS).difference == 2.0


def test_each_figure_moves_confidence_its_own_way():
    middle = Evidence(0.2, 0.0, -1.0, False, 0.5)
    sure = middle.confidence(SETTINGS)
    for better in ({"difference": 0.0}, {"everyday": 1.0}, {"sounds": 0.0}, {"same": True}, {"length": 1.0}):
        assert 1.0 >= replace(middle, **better).confidence(SETTINGS) > sure > 0.0


def test_scores_count_for_the_common_part_and_words_are_inside_for_the_most_part():
    assert score_within(EVERYDAY, 15, 29) == pytest.approx(-10.0 - 30.0)
    assert score_within(EVERYDAY, 50, 80) == 0.0
    assert [piece.word for piece in words_within(EVERYDAY, 14, 44)] == ["we", "stand", "up"]
    assert [piece.word for piece in words_within(EVERYDAY, 16, 43)] == ["stand"]
    assert [piece.word for piece in words_within(EVERYDAY, 25, 30)] == ["stand"]
    assert words_within(EVERYDAY, 0, 9) == []


@pytest.mark.parametrize(
    "one, other, wanted",
    [
        ("Y EH S", "Y EH S", 0.0),
        ("R EH D", "B R EH D", 1.0),
        ("P L IY Z", "P L EY Z", 0.6),
        ("F AY V", "F AY F", 0.5),
        ("N OW", "S T AA P", 3.6),
        ("", "HH EH L P", 4.0),
        ("", "", 0.0),
    ],
)
def test_the_cheapest_changes_count_in_both_directions(one, other, wanted):
    assert distance(one.split(), other.split()) == pytest.approx(wanted)
    assert distance(other.split(), one.split()) == pytest.approx(wanted)


@pytest.mark.parametrize("one, other, wanted", [("S", "S", 0.0), ("S", "Z", 0.5), ("AA", "IY", 0.6), ("S", "AA", 1.0)])
def test_phones_that_are_alike_differ_less(one, other, wanted):
    assert difference(one, other) == difference(other, one) == wanted


def test_tones_hums_and_noise_of_any_colour_are_no_speech():
    bounds = load_recognition().speech_likeness
    tone = likeness(np.sin(2.0 * np.pi * 440.0 * TIMES))
    assert tone.tone > bounds.most_tone and tone.change < 0.1
    assert likeness(sum(np.sin(2.0 * np.pi * 150.0 * k * TIMES) / k for k in range(1, 9))).change < bounds.least_change
    for power in (0.0, 0.5, 1.0):
        for seed in range(20):
            random = np.random.default_rng(seed)
            frames = round(random.uniform(0.2, 2.0) * RATE)
            spectrum = np.fft.rfft(random.standard_normal(frames)) / np.arange(1.0, frames // 2 + 2.0) ** power
            assert likeness(np.fft.irfft(spectrum, frames)).voice < bounds.least_voice, (power, seed)
