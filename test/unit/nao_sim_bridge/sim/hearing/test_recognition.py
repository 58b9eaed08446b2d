"""Words are recognised in real speech, and only there: in the process of the recogniser, and through it."""

from __future__ import annotations

import os
import signal
import threading
from time import monotonic

import numpy as np
import pytest
from fake_speech import LEVEL, RATE, blocks, in_a_room, spoken

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.hearing.bnf import parse_bnf
from nao_sim_bridge.sim.hearing.contexts import Contexts
from nao_sim_bridge.sim.hearing.grammar import vocabulary
from nao_sim_bridge.sim.hearing.listening import Listening, Recognised
from nao_sim_bridge.sim.hearing.recogniser import Recogniser, RecogniserRefused
from nao_sim_bridge.sim.hearing.voice_activity import SpeechChange
from nao_sim_bridge.sim.hearing.worker import Ear

PHRASES = ["yes", "no", "Stand up!", "room 21", "good morning", "red", "what is your name"]


@pytest.fixture(scope="module")
def ear():
    return Ear()


@pytest.fixture
def heard(ear):
    """What the ear makes of a stream."""

    def hear(stream):
        ear.finish(None)
        return [event for block in blocks(stream) for event in ear.hear(block)]

    return hear


def found(events):
    return [[h.phrase for h in e.hypotheses] for e in events if isinstance(e, Recognised)]


def test_phrases_are_recognised_as_they_were_written(ear, heard):
    ear.listen(Listening((vocabulary("v", PHRASES),)))
    said = ["stand up", "room twenty one", "good morning", "red"]
    events = heard(in_a_room(*map(spoken, said)))
    assert found(events) == [["Stand up!"], ["room 21"], ["good morning"], ["red"]]
    assert all(0.5 < e.hypotheses[0].confidence <= 1.0 for e in events if isinstance(e, Recognised))


def test_the_times_of_an_utterance_are_those_of_the_speech(ear, heard):
    ear.listen(Listening((vocabulary("v", PHRASES),)))
    speech = spoken("good morning", "awb")
    changes = [e for e in heard(in_a_room(speech)) if isinstance(e, SpeechChange)]
    assert [c.present for c in changes] == [True, False]
    loud = np.flatnonzero(np.abs(speech) > 0.1 * np.abs(speech).max()) / RATE
    assert changes[0].time == pytest.approx(1.1 + loud[0], abs=0.1)
    assert changes[1].time == pytest.approx(1.1 + loud[-1], abs=0.15)


def test_speech_in_noise_is_recognised(ear, heard):
    ear.listen(Listening((vocabulary("v", PHRASES),)))
    events = heard(in_a_room(spoken("good morning"), spoken("red", "awb"), noise=LEVEL / 10.0))
    assert found(events) == [["good morning"], ["red"]]


def test_several_hypotheses_come_best_first(ear, heard):
    ear.listen(Listening((vocabulary("v", ["red", "bread", "read", "what is your name"]),), hypotheses=3))
    (utterance,) = [e for e in heard(in_a_room(spoken("red"))) if isinstance(e, Recognised)]
    phrases, confidences = zip(*((h.phrase, h.confidence) for h in utterance.hypotheses))
    assert len(set(phrases)) == len(phrases) >= 2
    assert {"red", "read"} & set(phrases[:1])
    assert list(confidences) == sorted(confidences, reverse=True)


def test_other_speech_is_not_recognised(ear, heard):
    ear.listen(Listening((vocabulary("v", PHRASES),)))
    assert found(heard(in_a_room(spoken("the weather in the mountains is nice today")))) == [[]]


def test_one_phrase_has_one_hypothesis(ear, heard):
    ear.listen(Listening((vocabulary("v", ["good morning"]),), hypotheses=3))
    assert found(heard(in_a_room(spoken("good morning")))) == [["good morning"]]


def test_other_speech_alone_is_no_phrase(ear, heard):
    contexts = Contexts()
    contexts.add("any", parse_bnf("#BNF+EM V2.1; !grammar g; !start <s>; <s>: <...>;"))
    ear.listen(Listening(tuple(contexts.grammars())))
    assert found(heard(in_a_room(spoken("good morning")))) == [[]]


@pytest.mark.parametrize("text", ["good morning", "what is your name"])
def test_a_word_is_spotted_when_it_is_all_that_is_said(ear, heard, text):
    ear.listen(Listening((vocabulary("v", ["what is your name", "good morning"], word_spotting=True),)))
    assert found(heard(in_a_room(spoken(text)))) == [[f"<...> {text} <...>"]]


@pytest.mark.parametrize("text", ["she plays the violin every day", "this box is very heavy", "the river is deep"])
def test_nothing_is_spotted_in_other_speech(ear, heard, text):
    ear.listen(Listening((vocabulary("v", PHRASES, word_spotting=True),)))
    assert found(heard(in_a_room(spoken(text, "awb")))) == [[]]


def test_a_word_is_spotted_inside_of_longer_speech(ear, heard):
    ear.listen(Listening((vocabulary("v", ["what is your name", "good morning"], word_spotting=True),)))
    events = heard(in_a_room(spoken("hello my friend good morning to everybody")))
    assert found(events) == [["<...> good morning <...>"]]


def test_a_grammar_with_rules_is_recognised(ear, heard):
    contexts = Contexts()
    text = "#BNF+EM V2.1; !grammar g; !start <s>; <s>: turn (on | off) the (light | radio) [please];"
    contexts.add("house", parse_bnf(text))
    ear.listen(Listening(tuple(contexts.grammars())))
    events = heard(in_a_room(spoken("turn off the radio please"), spoken("turn on the light", "awb")))
    assert found(events) == [["turn off the radio please"], ["turn on the light"]]
    assert {h.grammar for e in events if isinstance(e, Recognised) for h in e.hypotheses} == {"house"}


@pytest.mark.parametrize("sound", ["silence", "noise", "tones", "hum", "clicks"])
def test_what_is_no_speech_is_not_recognised(ear, heard, sound):
    times = np.arange(8 * RATE) / RATE
    gate = times % 1.6 < 0.7
    wave = {
        "silence": 0.0 * times,
        "noise": np.random.default_rng(5).standard_normal(len(times)),
        "tones": np.sin(2.0 * np.pi * 440.0 * times) * gate,
        "hum": sum(np.sin(2.0 * np.pi * 150.0 * k * times) / k for k in range(1, 9)) * gate,
        "clicks": 20.0 * (np.arange(len(times)) % 9000 < 40),
    }[sound]
    ear.listen(Listening((vocabulary("v", PHRASES),)))
    assert [phrases for phrases in found(heard(in_a_room(LEVEL * wave))) if phrases] == []


def test_grammars_that_are_too_large_are_refused(ear):
    rules = "".join(f"<r{i}>: <r{i + 1}> <r{i + 1}>;\n" for i in range(40))
    contexts = Contexts()
    contexts.add("deep", parse_bnf(f"#BNF+EM V2.1;\n!grammar x;\n!start <r0>;\n{rules}<r40>: word;\n"))
    with pytest.raises(BadValue, match="smaller"):
        ear.listen(Listening(tuple(contexts.grammars())))


class Events:
    """What a recogniser told."""

    def __init__(self):
        self.all = []
        self.recognised = threading.Event()

    def __call__(self, event):
        self.all.append(event)
        if isinstance(event, Recognised):
            self.recognised.set()


@pytest.fixture
def recogniser():
    events = Events()
    made = Recogniser(events)
    made.events = events
    yield made
    made.close()


def hear_all(recogniser, stream, begin=0.0):
    for time, samples in blocks(stream):
        recogniser.hear(begin + time, samples)
    recogniser.catch_up()


def test_the_process_recognises_and_is_started_again_when_it_has_died(recogniser):
    recogniser.listen(Listening((vocabulary("v", PHRASES),)))
    stream = in_a_room(spoken("good morning"))
    hear_all(recogniser, stream)
    first = recogniser.pid
    os.kill(first, signal.SIGKILL)
    hear_all(recogniser, stream, 10.0)
    assert recogniser.pid not in (None, first)
    assert found(recogniser.events.all) == [["good morning"], ["good morning"]]
    assert recogniser.lag == 0.0


def test_a_refused_word_leaves_the_vocabulary_as_it_was(recogniser):
    recogniser.listen(Listening((vocabulary("v", PHRASES),)))
    with pytest.raises(RecogniserRefused, match="猫"):
        recogniser.listen(Listening((vocabulary("v", ["猫"]),)))
    hear_all(recogniser, in_a_room(spoken("good morning")))
    assert found(recogniser.events.all) == [["good morning"]]


def test_sound_that_waits_is_lag(recogniser):
    recogniser.listen(Listening((vocabulary("v", PHRASES),)))
    os.kill(recogniser.pid, signal.SIGSTOP)
    try:
        for time, samples in blocks(in_a_room())[:3]:
            recogniser.hear(time, samples)
        assert recogniser.lag == pytest.approx(3 * 0.17)
    finally:
        os.kill(recogniser.pid, signal.SIGCONT)
    recogniser.catch_up()
    assert recogniser.lag == 0.0


def test_a_process_that_hangs_does_not_hold_up_the_end(recogniser, caplog):
    recogniser.listen(Listening((vocabulary("v", PHRASES),)))
    pid = recogniser.pid
    os.kill(pid, signal.SIGSTOP)
    for time, samples in blocks(in_a_room())[:3]:
        recogniser.hear(time, samples)
    begin = monotonic()
    recogniser.close()
    assert monotonic() - begin < 10.0
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    assert not caplog.records


def test_a_word_without_end_is_refused_with_a_reason(recogniser):
    with pytest.raises(RecogniserRefused, match=r"'aaaaaaaaaaaaaaaaaaaa...': it is longer than 64 letters") as refused:
        recogniser.listen(Listening((vocabulary("v", ["yes", "a" * 100000]),)))
    assert len(str(refused.value)) < 200
