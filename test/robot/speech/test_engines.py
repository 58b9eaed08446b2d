"""The engines of this machine, in their process."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest
from waits import hold

from nao_sim_bridge.speech.engines import Engines, SpeechError, Utterance
from nao_sim_bridge.speech.voices import load_voices

ENGLISH = ("flite", "slt")
GERMAN = ("espeak-ng", "de")


def words(speech, text):
    return [text[word.first : word.first + word.length] for word in speech.words]


def test_every_voice_of_the_table_speaks(engines):
    for name, voice in load_voices().voices.items():
        speech = engines.synthesise(Utterance(voice.engine, voice.engine_voice, "1 2 3"))
        assert speech.duration > 0.3 and np.abs(speech.samples).max() > 0.1, name
        assert [word.first for word in speech.words] == [0, 2, 4], name


def test_words_are_those_that_are_written(engines):
    text = "Hello 42 world, that's Dr. Smith’s naïve café - for €5!"
    expected = ["Hello", "42", "world", "that's", "Dr", "Smith’s", "naïve", "café", "for"]
    assert words(engines.synthesise(Utterance(*ENGLISH, text)), text)[:9] == expected
    text = "Guten Tag, Herr Müller: 42 Äpfel!"
    speech = engines.synthesise(Utterance(*GERMAN, text))
    assert words(speech, text) == ["Guten", "Tag,", "Herr", "Müller:", "42", "Äpfel!"]


@pytest.mark.parametrize("voice", [ENGLISH, GERMAN])
def test_the_times_of_words_fit_the_silences_of_the_sound(engines, voice):
    """Between two sentences there is silence where no word is said, and sound where one is."""
    speech = engines.synthesise(Utterance(*voice, "Banana, banana. Melon."))
    level = np.abs(speech.samples)
    assert len(speech.words) == 3
    assert all(a.end <= b.start + 1e-6 for a, b in zip(speech.words, speech.words[1:]))
    spoken, margin = np.zeros(len(level), bool), round(0.02 * speech.rate)
    for word in speech.words:
        part = slice(round(word.start * speech.rate), round(word.end * speech.rate))
        assert level[part].max() > 0.25 * level.max()
        spoken[max(part.start - margin, 0) : part.stop + margin] = True
    assert level[~spoken].max() < 0.1 * level.max()
    assert np.mean(~spoken) > 0.03


def test_what_is_missing_is_named(engines):
    assert engines.missing(*ENGLISH) is None
    assert "has no voice 'bob', it has slt" in engines.missing("flite", "bob")
    assert "unknown engine 'festival', there are espeak-ng, flite" in engines.missing("festival", "x")
    with pytest.raises(SpeechError, match="espeak-ng has no voice 'xx-yy'"):
        engines.synthesise(Utterance("espeak-ng", "xx-yy", "text"))


@pytest.fixture
def own():
    """Engines in a process of this test's own."""
    made = Engines()
    yield made
    made.close()


def test_a_dead_process_is_started_again_and_ends_with_its_engines(own):
    own.synthesise(Utterance(*ENGLISH, "One."))
    first = own.pid
    os.kill(first, signal.SIGKILL)
    os.waitid(os.P_PID, first, os.WEXITED | os.WNOWAIT)
    assert own.synthesise(Utterance(*ENGLISH, "Two.")).duration > 0.3
    second = own.pid
    assert second != first
    own.close()
    with pytest.raises(ProcessLookupError):
        os.kill(second, 0)


def test_a_process_that_does_not_answer_is_an_error_and_the_next_text_is_spoken(own):
    assert own.missing(*ENGLISH) is None
    hold(own.pid)
    own.answer_timeout = 0.05
    with pytest.raises(SpeechError, match="speaking 'One.': no answer of the speech process within 0.05 s"):
        own.synthesise(Utterance(*ENGLISH, "One."))
    own.answer_timeout = 30.0
    assert own.synthesise(Utterance(*ENGLISH, "Two.")).duration > 0.3
