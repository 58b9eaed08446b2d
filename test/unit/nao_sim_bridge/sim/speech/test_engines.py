"""The engines of this machine, in their process."""

from __future__ import annotations

import os
import signal
import threading
from multiprocessing import Pipe
from time import monotonic

import numpy as np
import pytest

from nao_sim_bridge.sim.speech import worker
from nao_sim_bridge.sim.speech.engines import Engines
from nao_sim_bridge.sim.speech.speech import SpeechError, Utterance
from nao_sim_bridge.sim.speech.voices import load_voices

ENGLISH = ("flite", "slt")
GERMAN = ("espeak-ng", "de")
# How far the time of a word may be off, s.
MARGIN = 0.02


def words(speech, text):
    return [text[word.first : word.first + word.length] for word in speech.words]


@pytest.mark.parametrize("name", load_voices().voices)
def test_every_voice_of_the_table_speaks(engines, name):
    voice = load_voices().voices[name]
    speech = engines.synthesise(Utterance(voice.engine, voice.engine_voice, "1 2 3"))
    assert speech.duration > 0.3 and np.abs(speech.samples).max() > 0.1
    assert [word.first for word in speech.words] == [0, 2, 4]


def test_words_are_those_that_are_written(engines):
    text = "Hello 42 world, that's Dr. Smith’s naïve café - for €5!"
    expected = ["Hello", "42", "world", "that's", "Dr", "Smith’s", "naïve", "café", "for"]
    assert words(engines.synthesise(Utterance(*ENGLISH, text)), text)[:9] == expected
    text = "Guten Tag, Herr Müller: 42 Äpfel!"
    speech = engines.synthesise(Utterance(*GERMAN, text))
    assert words(speech, text) == ["Guten", "Tag,", "Herr", "Müller:", "42", "Äpfel!"]


@pytest.mark.parametrize("voice", [ENGLISH, ("flite", "rms"), ("flite", "kal16"), GERMAN, ("espeak-ng", "en-us")])
def test_the_times_of_words_fit_the_silences_of_the_sound(engines, voice):
    """Between two sentences there is silence where no word is said, and sound where one is."""
    text = "Banana, banana. Melon."
    speech = engines.synthesise(Utterance(*voice, text))
    level = np.abs(speech.samples)
    loudest = level.max()
    assert len(speech.words) == 3
    assert all(a.end <= b.start + 1e-6 for a, b in zip(speech.words, speech.words[1:]))
    spoken = np.zeros(len(level), bool)
    for word in speech.words:
        part = slice(round(word.start * speech.rate), round(word.end * speech.rate))
        assert level[part].max() > 0.25 * loudest
        spoken[max(part.start - round(MARGIN * speech.rate), 0) : part.stop + round(MARGIN * speech.rate)] = True
    assert level[~spoken].max() < 0.1 * loudest
    assert np.mean(~spoken) > 0.03


@pytest.mark.parametrize("voice", [ENGLISH, ("flite", "kal16"), GERMAN])
@pytest.mark.parametrize("speed", [0.5, 2.0, 4.0])
def test_speed_makes_it_that_much_shorter(engines, voice, speed):
    text = "The robot walks slowly around the table and looks at everybody there."
    usual = engines.synthesise(Utterance(*voice, text)).duration
    assert engines.synthesise(Utterance(*voice, text, speed)).duration == pytest.approx(usual / speed, rel=0.2)


@pytest.mark.parametrize("text", ["", " ", "...", "你好", "\U0001f600", "a\0b", "<b>&amp;</b>", "-v $(reboot); `x`"])
@pytest.mark.parametrize("voice", [ENGLISH, GERMAN])
def test_any_text_gives_a_sound_perhaps_an_empty_one(engines, voice, text):
    speech = engines.synthesise(Utterance(*voice, text))
    assert speech.duration < 10.0
    assert engines.synthesise(Utterance(*voice, "Well.")).words


def test_the_same_text_sounds_the_same(engines):
    first, _, second = [engines.synthesise(Utterance(*ENGLISH, text)) for text in ("Same.", "Other one.", "Same.")]
    assert np.array_equal(first.samples, second.samples)


def test_what_is_missing_is_named(engines):
    assert engines.missing(*ENGLISH) is None
    assert "has no voice 'bob', it has slt" in engines.missing("flite", "bob")
    assert "unknown engine 'festival', there are espeak-ng, flite" in engines.missing("festival", "x")
    with pytest.raises(SpeechError, match="espeak-ng has no voice 'xx-yy'"):
        engines.synthesise(Utterance("espeak-ng", "xx-yy", "text"))


@pytest.fixture
def own():
    """Makes engines in a process of this test's own; `lacking` are the libraries that it does not find."""
    made = []

    def make(*lacking):
        made.append(Engines())
        made[-1].lacking = lacking
        return made[-1]

    yield make
    for engines in made:
        engines.close()


def test_a_dead_process_is_told_and_started_again(own):
    engines = own()
    engines.synthesise(Utterance(*ENGLISH, "One."))
    first = engines.pid
    os.kill(first, signal.SIGKILL)
    os.waitid(os.P_PID, first, os.WEXITED | os.WNOWAIT)
    assert engines.synthesise(Utterance(*ENGLISH, "Two.")).duration > 0.3
    assert engines.pid != first


def test_a_process_that_dies_while_it_speaks_is_an_error_and_the_next_text_is_spoken(own):
    engines = own()
    assert engines.missing(*ENGLISH) is None
    os.kill(engines.pid, signal.SIGSTOP)
    engines.answer_timeout = 0.05
    with pytest.raises(SpeechError, match="speaking 'One.': no answer of the speech process within 0.05 s"):
        engines.synthesise(Utterance(*ENGLISH, "One."))
    engines.answer_timeout = 30.0
    assert engines.synthesise(Utterance(*ENGLISH, "Two.")).duration > 0.3


def test_an_engine_that_is_not_installed_is_named_with_its_package(own):
    engines = own("espeak-ng")
    assert engines.missing(*ENGLISH) is None
    problem = engines.missing(*GERMAN)
    assert "the engine espeak-ng is not installed (Debian package espeak-ng)" in problem
    with pytest.raises(SpeechError, match="is not installed"):
        engines.synthesise(Utterance(*GERMAN, "Guten Tag."))


def test_the_process_ends_with_its_engines(own):
    engines = own()
    engines.synthesise(Utterance(*ENGLISH, "One."))
    pid = engines.pid
    engines.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_process_that_hangs_does_not_hold_up_the_end(own):
    engines = own()
    engines.synthesise(Utterance(*ENGLISH, "One."))
    pid, errors = engines.pid, []

    def speak():
        try:
            engines.synthesise(Utterance(*ENGLISH, "Two."))
        except SpeechError as error:
            errors.append(str(error))

    os.kill(pid, signal.SIGSTOP)
    speaking = threading.Thread(target=speak)
    speaking.start()
    begin = monotonic()
    while not engines._lock.locked() and monotonic() < begin + 10.0:
        speaking.join(0.01)
    engines.close()
    speaking.join(10.0)
    assert monotonic() - begin < 10.0
    assert errors == ["speaking 'Two.': the speech process ended with status -9"]
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


class Defect:
    """An engine with a defect."""

    def prepare(self, voice):
        """Nothing to prepare."""

    def synthesise(self, *_):
        raise TypeError("a defect")


def test_a_defect_of_an_engine_is_answered():
    here, there = Pipe()
    worker._speak(there, Defect(), ["slt", "One.", 1.0])
    assert here.poll(10.0)
    assert here.recv() == ("error", "a defect")
