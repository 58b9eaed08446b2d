"""Words are recognised in real speech, and only there: by an ear of its own, and in the process of the recogniser."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest
from spoken_words import LEVEL, RATE, ROOM, audible, blocks, in_a_room, spoken

from nao_sim_bridge.hearing.grammars.bnf import parse_bnf
from nao_sim_bridge.hearing.grammars.contexts import Contexts
from nao_sim_bridge.hearing.grammars.grammar import vocabulary
from nao_sim_bridge.hearing.listening import Listening, Recognised
from nao_sim_bridge.hearing.recogniser import Recogniser, RecogniserRefused
from nao_sim_bridge.hearing.voice_activity import SpeechChange

LISTENING = Listening((vocabulary("v", ["yes", "good morning"]),))


def recognised(events):
    return [event for event in events if isinstance(event, Recognised)]


def found(events):
    return [[h.phrase for h in event.hypotheses] for event in recognised(events)]


def grammars(text, name="house"):
    contexts = Contexts()
    contexts.add(name, parse_bnf(f"#BNF+EM V2.1; !grammar g; !start <s>; <s>: {text}"))
    return tuple(contexts.grammars())


def test_phrases_are_recognised_as_they_were_written_and_other_speech_is_not(heard):
    said = [spoken("stand up"), spoken("room twenty one"), spoken("the weather in the mountains is nice today")]
    events = heard(in_a_room(*said))
    assert found(events) == [["Stand up!"], ["room 21"], []]
    events += heard(in_a_room(spoken("good morning"), spoken("red", "awb"), noise=LEVEL / 10.0))
    assert found(events)[3:] == [["good morning"], ["red"]]
    assert all(0.5 < e.hypotheses[0].confidence <= 1.0 for e in recognised(events) if e.hypotheses)


def test_the_times_of_an_utterance_are_those_of_the_speech(heard):
    speech = spoken("good morning", "awb")
    changes = [e for e in heard(in_a_room(speech)) if isinstance(e, SpeechChange)]
    assert [c.present for c in changes] == [True, False]
    loud = np.flatnonzero(np.abs(speech) > 0.1 * np.abs(speech).max()) / RATE
    assert changes[0].time == pytest.approx(1.1 + loud[0], abs=0.1)
    assert changes[1].time == pytest.approx(1.1 + loud[-1], abs=0.15)


def test_a_phrase_has_the_times_of_its_first_and_last_sound(heard):
    speech = spoken("stand up", "rms")
    first, last = audible(speech)
    for noise in (ROOM, LEVEL / 10.0):
        (event,) = recognised(heard(in_a_room(speech, noise=noise), ["stand up", "red"]))
        (best,) = event.hypotheses
        assert best.onset == pytest.approx(1.1 + first, abs=0.03)
        assert best.end == pytest.approx(1.1 + last, abs=0.03 if noise == ROOM else 0.13)  # its burst is lost in noise


def test_a_word_right_at_the_begin_is_recognised_by_who_knows_the_background(ear):
    ear.listen(LISTENING)
    ear.finish(None)
    ear.background(in_a_room(pause=1.5, noise=LEVEL / 10.0))
    speech = in_a_room(spoken("good morning"), noise=LEVEL / 10.0)
    first, _ = audible(spoken("good morning"))
    stream = speech[round((1.1 + first - 0.02) * RATE) :]
    events = [event for block in blocks(stream) for event in ear.hear(block)]
    assert found(events) == [["good morning"]]
    assert recognised(events)[0].hypotheses[0].onset == pytest.approx(0.02, abs=0.03)


def test_several_hypotheses_come_best_first_and_one_phrase_has_one(heard):
    phrases = ["red", "bread", "read", "what is your name"]
    (utterance,) = recognised(heard(in_a_room(spoken("red")), phrases, hypotheses=3))
    said, confidences = zip(*((h.phrase, h.confidence) for h in utterance.hypotheses))
    assert len(set(said)) == len(said) >= 2 and said[0] in ("red", "read")
    assert list(confidences) == sorted(confidences, reverse=True)
    stream = in_a_room(spoken("good morning"))
    assert found(heard(stream, ["good morning"], hypotheses=3)) == [["good morning"]]
    assert found(heard(stream, grammars=grammars("<...>;"))) == [[]]  # other speech alone is no phrase


def test_a_word_is_spotted_when_it_is_all_that_is_said_and_inside_of_longer_speech(heard):
    for text in ("good morning", "hello my friend good morning to everybody"):
        events = heard(in_a_room(spoken(text)), ["what is your name", "good morning"], word_spotting=True)
        assert found(events) == [["<...> good morning <...>"]]
    assert found(heard(in_a_room(spoken("the river is deep", "awb")), word_spotting=True)) == [[]]


def test_a_grammar_with_rules_is_recognised(heard):
    rules = grammars("turn (on | off) the (light | radio) [please];")
    events = heard(in_a_room(spoken("turn off the radio please"), spoken("turn on the light", "awb")), grammars=rules)
    assert found(events) == [["turn off the radio please"], ["turn on the light"]]
    assert {h.grammar for e in recognised(events) for h in e.hypotheses} == {"house"}


@pytest.fixture
def recogniser():
    events = []
    made = Recogniser(events.append)
    made.events = events
    made.listen(LISTENING)
    yield made
    made.close()


def hear_all(recogniser, begin=0.0):
    for time, samples in blocks(in_a_room(spoken("good morning"))):
        recogniser.hear(begin + time, samples)
    recogniser.catch_up()


def test_the_process_recognises_and_is_started_again_when_it_has_died(recogniser):
    with pytest.raises(RecogniserRefused, match="猫"):
        recogniser.listen(Listening((vocabulary("v", ["猫"]),)))
    hear_all(recogniser)
    first = recogniser.pid
    os.kill(first, signal.SIGKILL)
    hear_all(recogniser, 10.0)
    assert recogniser.pid not in (None, first)
    assert found(recogniser.events) == [["good morning"], ["good morning"]]
    assert recogniser.lag == 0.0
