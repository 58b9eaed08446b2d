"""The engines of this machine, in their process."""

from __future__ import annotations

import os
import signal
import threading
from time import monotonic

import numpy as np
import pytest

from nao_sim_bridge.sim.speech.engines import Engines
from nao_sim_bridge.sim.speech.speech import SpeechError, Utterance
from nao_sim_bridge.sim.speech.voices import load_voices

ENGLISH = ("flite", "slt")
GERMAN = ("espeak-ng", "de")
# How far the time of a word may be off, s.
MARGIN = 0.02


def words(speech, text):
    return [text[word.first : word.first + word.length] for word in speech.words]


def gone(pid):
    """Whether a process has ended."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False


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


@pytest.mark.parametrize("voice", [ENGLISH, ("flite", "rms"), ("flite", "kal16"), GERMAN, ("espeak-ng", "en-us")])
def test_the_times_of_words_fit_the_silences_of_the_sound(engines, voice):
    """Between two sentences there is silence where no word is said, and sound where one is."""
    speech = engines.synthesise(Utterance(*voice, "Banana, banana. Melon."))
    level = np.abs(speech.samples)
    assert len(speech.words) == 3
    assert all(a.end <= b.start + 1e-6 for a, b in zip(speech.words, speech.words[1:]))
    spoken, margin = np.zeros(len(level), bool), round(MARGIN * speech.rate)
    for word in speech.words:
        part = slice(round(word.start * speech.rate), round(word.end * speech.rate))
        assert level[part].max() > 0.25 * level.max()
        spoken[max(part.start - margin, 0) : part.stop + margin] = True
    assert level[~spoken].max() < 0.1 * level.max()
    assert np.mean(~spoken) > 0.03


@pytest.mark.parametrize("voice", [ENGLISH, ("flite", "kal16"), GERMAN])
def test_speed_makes_it_that_much_shorter(engines, voice):
    text = "The robot walks slowly around the table and looks at everybody there."
    usual = engines.synthesise(Utterance(*voice, text)).duration
    for speed in (0.5, 2.0, 4.0):
        assert engines.synthesise(Utterance(*voice, text, speed)).duration == pytest.approx(usual / speed, rel=0.2)


@pytest.mark.parametrize("voice", [ENGLISH, GERMAN])
def test_any_text_gives_a_sound_perhaps_an_empty_one(engines, voice):
    for text in ["", " ", "...", "你好", "\U0001f600", "a\0b", "<b>&amp;</b>", "-v $(reboot); `x`"]:
        assert engines.synthesise(Utterance(*voice, text)).duration < 10.0
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


# --- the process ------------------------------------------------------------------------------------------------------


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
    assert gone(second)


def test_a_process_that_does_not_answer_is_an_error_and_the_next_text_is_spoken(own):
    assert own.missing(*ENGLISH) is None
    os.kill(own.pid, signal.SIGSTOP)
    own.answer_timeout = 0.05
    with pytest.raises(SpeechError, match="speaking 'One.': no answer of the speech process within 0.05 s"):
        own.synthesise(Utterance(*ENGLISH, "One."))
    own.answer_timeout = 30.0
    assert own.synthesise(Utterance(*ENGLISH, "Two.")).duration > 0.3
    with pytest.raises(SpeechError, match="speaking 'Three.': .+"):
        own.synthesise(Utterance(*ENGLISH, "Three.", "fast"))  # what fails inside of an engine is answered
    assert own.synthesise(Utterance(*ENGLISH, "Four.")).duration > 0.3


def test_an_engine_that_is_not_installed_is_named_with_its_package(own):
    own.lacking = ("espeak-ng",)
    assert own.missing(*ENGLISH) is None
    assert "the engine espeak-ng is not installed (Debian package espeak-ng)" in own.missing(*GERMAN)
    with pytest.raises(SpeechError, match="is not installed"):
        own.synthesise(Utterance(*GERMAN, "Guten Tag."))


def test_a_process_that_hangs_does_not_hold_up_the_end(own):
    own.synthesise(Utterance(*ENGLISH, "One."))
    pid, errors, asked = own.pid, [], threading.Event()

    class Speed(float):
        """Tells when it goes to the process."""

        def __reduce__(self):
            asked.set()
            return float, (1.0,)

    def speak():
        try:
            own.synthesise(Utterance(*ENGLISH, "Two.", Speed(1.0)))
        except SpeechError as error:
            errors.append(str(error))

    os.kill(pid, signal.SIGSTOP)
    speaking = threading.Thread(target=speak)
    speaking.start()
    assert asked.wait(15.0)
    begin = monotonic()
    own.close()
    speaking.join(10.0)
    assert monotonic() - begin < 10.0
    assert errors == ["speaking 'Two.': the speech process ended with status -9"]
    assert gone(pid)
