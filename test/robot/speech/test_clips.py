"""Sentences as sound: parameters and tags can be heard, words and marks come when they are said."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.speech.clips import ClipMaker, SpokenWord
from nao_sim_bridge.speech.parameters import DoubleVoice, Prosody
from nao_sim_bridge.speech.tags import Bookmark

TEXT = "We are all away now."


def fundamental(samples, lowest=50.0, highest=500.0):
    """Median of the fundamental frequency where a voice sounds, Hz."""
    size, found = round(0.06 * RATE), []
    for begin in range(0, len(samples) - size, size // 2):
        block = samples[begin : begin + size] - samples[begin : begin + size].mean()
        if np.sqrt(np.mean(block**2)) < 0.02:
            continue
        likeness = np.fft.irfft(np.abs(np.fft.rfft(block * np.hanning(size), 4 * size)) ** 2)
        first, last = int(RATE / highest), int(RATE / lowest)
        lag = first + int(np.argmax(likeness[first:last]))
        if likeness[lag] > 0.4 * likeness[0]:
            found.append(RATE / lag)
    return float(np.median(found))


def samples(clip):
    return clip.sound.samples[:, 0]


def loud(clip, start, end):
    """Level between two times in s, as part of the loudest 20 ms of all."""
    sound, block = samples(clip), round(0.02 * RATE)
    peak = max(np.sqrt(np.mean(sound[i : i + block] ** 2)) for i in range(0, len(sound) - block, block))
    return float(np.sqrt(np.mean(sound[round(start * RATE) : round(end * RATE)] ** 2)) / peak)


def words(clip):
    return [mark.text for _, mark in clip.marks]


def test_words_are_told_without_punctuation_and_counted(clip):
    expected = [SpokenWord(t, i) for i, t in enumerate(["Well", "that's", "it", "42", "times"])]
    assert [mark for _, mark in clip("Well, (that's) it: 42 “times”!").marks] == expected
    marks = {mark: time for time, mark in clip(r"one \mrk=5\ two\mrk=6\ ").marks}
    assert marks[Bookmark(5)] == marks[SpokenWord("two", 1)] < marks[Bookmark(6)]


@pytest.mark.parametrize("voice", ["naoenu", "naogem"])
def test_a_pause_is_silent_and_as_long_as_it_says(clip, voice):
    short, long = (clip(rf"Banana \pau={length}\ banana", voice) for length in (300, 1300))
    assert long.sound.duration - short.sound.duration == pytest.approx(1.0, abs=0.001)
    second = [time for time, _ in long.marks][1]
    assert loud(long, second - 0.95, second - 0.05) < 0.01
    assert loud(long, second, second + 0.3) > 0.2


@pytest.mark.parametrize("voice", ["naoenu", "kal16", "naogem", "naojpe"])
def test_all_voices_are_about_equally_loud(clip, voice):
    sound = samples(clip("こんにちは" if voice == "naojpe" else TEXT, voice))
    assert 0.05 < np.sqrt(np.mean(sound[np.abs(sound) > 0.02] ** 2)) < 0.35
    assert np.abs(sound).max() <= 0.81


@pytest.mark.parametrize("voice, factor", [("naoenu", 0.8), ("naogem", 2.0)])
def test_pitch_moves_the_fundamental_and_leaves_the_length(clip, voice, factor):
    plain, shifted = clip(TEXT, voice), clip(TEXT, voice, prosody=Prosody(pitch=factor))
    assert fundamental(samples(shifted)) == pytest.approx(factor * fundamental(samples(plain)), rel=0.06)
    assert shifted.sound.duration == plain.sound.duration and shifted.marks == plain.marks
    assert np.array_equal(samples(clip(rf"\vct={100 * factor:g}\{TEXT}", voice)), samples(shifted))


@pytest.mark.parametrize("speed", [0.5, 2.0, 4.0])
def test_faster_is_shorter(clip, speed):
    usual = clip(TEXT).sound.duration
    assert clip(TEXT, prosody=Prosody(speed=speed)).sound.duration == pytest.approx(usual / speed, rel=0.2)
    assert clip(rf"\rspd={speed * 100:g}\{TEXT}").sound.duration == pytest.approx(usual / speed, rel=0.2)


def test_the_tag_of_volume_scales_the_sound(clip):
    plain, half, full = clip(TEXT), clip(rf"\vol=40\{TEXT}"), clip(rf"\vol=100\{TEXT}")
    assert np.allclose(samples(half), 0.5 * samples(plain), atol=1e-6)
    assert np.allclose(samples(full), 1.25 * samples(plain), atol=1e-6)
    assert not np.any(samples(clip(rf"\vol=0\{TEXT}")))


def test_the_second_voice_speaks_along_later_and_higher(clip):
    plain, both = samples(clip(TEXT)), samples(clip(TEXT, double=DoubleVoice(1.0, 0.5, 0.1)))
    delay = round(0.1 * RATE)
    assert len(both) == pytest.approx(len(plain) + delay, abs=4)
    expected = np.zeros(len(both))
    expected[: len(plain)] += plain
    expected[delay : delay + len(plain)] += 0.5 * plain[: len(expected) - delay]
    assert np.corrcoef(expected, both)[0, 1] > 0.999
    higher = samples(clip(TEXT, double=DoubleVoice(2.0, 1.0, 0.0)))
    assert np.corrcoef(higher[: len(plain)], plain)[0, 1] < 0.95


def test_repeated_texts_are_made_once(counting, clip):
    maker = ClipMaker(counting)
    first, again = clip("Never said before.", maker=maker), clip("Never said before.", maker=maker)
    clip("Never said before.", maker=maker, prosody=Prosody(gain=0.5))
    assert counting.asked == 1 and np.array_equal(samples(first), samples(again))
