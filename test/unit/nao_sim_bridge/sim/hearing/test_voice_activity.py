"""Where speech begins and ends, for sounds made by hand."""

from __future__ import annotations

import numpy as np
import pytest
from fake_speech import blocks

from nao_sim_bridge.sim.hearing.settings import load_recognition
from nao_sim_bridge.sim.hearing.voice_activity import RATE, SpeechChange, Utterance, VoiceActivity


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
    events = heard(stream((2.0, -74.0), (0.8, -40.0), (1.5, -74.0)), begin=100.0)
    assert [(type(e), getattr(e, "present", None)) for e in events] == [
        (SpeechChange, True),
        (SpeechChange, False),
        (Utterance, None),
    ]
    assert events[0].time == pytest.approx(102.0, abs=0.1)
    assert events[1].time == pytest.approx(102.8, abs=0.05)
    (found,) = utterances(events)
    assert (found.start, found.end) == (events[0].time, events[1].time)
    assert 0.8 + 0.2 < len(found.samples) / RATE < 0.8 + 0.8
    assert 20.0 * np.log10(np.std(found.background)) == pytest.approx(-74.0, abs=1.0)


def test_a_short_pause_belongs_to_the_utterance_and_a_long_one_ends_it():
    short = heard(stream((2.0, -74.0), (0.5, -40.0), (0.3, -74.0), (0.5, -40.0), (1.0, -74.0)))
    long = heard(stream((2.0, -74.0), (0.5, -40.0), (0.7, -74.0), (0.5, -40.0), (1.0, -74.0)))
    assert (len(utterances(short)), len(utterances(long))) == (1, 2)


@pytest.mark.parametrize("parts", [[(5.0, -74.0)], [(2.0, -74.0), (0.02, -30.0), (2.0, -74.0)], [(6.0, -45.0)]])
def test_silence_clicks_and_steady_noise_are_no_utterance(parts):
    assert utterances(heard(stream(*parts))) == []


def test_more_sensitive_ears_hear_quieter_speech():
    sound = stream((2.0, -60.0), (0.8, -52.0), (1.5, -60.0))
    assert [len(utterances(heard(sound, sensitivity))) for sensitivity in (0.0, 1.0)] == [0, 1]


def test_an_utterance_without_end_is_cut():
    longest = load_recognition().voice_activity.longest_s
    rhythm = [(0.3, -40.0), (0.2, -74.0)] * round(2.2 * longest)
    found = utterances(heard(stream((2.0, -74.0), *rhythm, (1.0, -74.0))))
    assert len(found) >= 2
    assert max(len(u.samples) / RATE for u in found) < longest + 1.0


def test_a_gap_in_time_ends_the_utterance():
    activity = VoiceActivity(load_recognition())
    talk = blocks(stream((2.0, -74.0), (3.0, -40.0)))[:18]
    events = [event for time, samples in talk for event in activity.hear(time, samples)]
    assert [e.present for e in events] == [True]
    later = list(activity.hear(50.0, talk[0][1]))
    assert [type(e) for e in later] == [SpeechChange, Utterance]
    assert later[1].end < 5.0


def test_the_end_of_listening_ends_the_utterance():
    activity = VoiceActivity(load_recognition())
    for time, samples in blocks(stream((2.0, -74.0), (1.0, -40.0))):
        list(activity.hear(time, samples))
    assert len(utterances(activity.finish())) == 1
    assert list(activity.finish()) == []
