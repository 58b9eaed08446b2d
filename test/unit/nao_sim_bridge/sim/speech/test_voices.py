"""Languages and voices."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.speech.speech import SpeechError
from nao_sim_bridge.sim.speech.voices import load_voices

NAMES = {"English": "naoenu", "French": "naofrf", "German": "naogem", "Spanish": "naosps", "Italian": "naoitv"}


class Installed:
    """Engines of a machine."""

    def __init__(self, *engines):
        self.engines = engines

    def missing(self, engine, voice):
        return None if engine in self.engines else f"the engine {engine} is not installed"


@pytest.mark.parametrize("language, voice", NAMES.items())
def test_the_robots_own_voices_are_the_defaults(language, voice):
    assert load_voices().languages[language].voices[0] == voice
    assert load_voices().voices[voice].language == language


def test_a_language_is_available_when_one_of_its_voices_is():
    voices = load_voices()
    assert voices.available_languages(Installed("flite")) == ["English"]
    assert set(voices.available_languages(Installed("espeak-ng"))) == set(voices.languages)
    assert voices.available_languages(Installed()) == []
    assert "naoenu" not in voices.available_voices(Installed("espeak-ng"))


def test_errors_list_what_is_allowed():
    voices, both = load_voices(), Installed("flite", "espeak-ng")
    with pytest.raises(BadValue, match="'Klingon', allowed is one of English, French, German"):
        voices.language("Klingon", both)
    with pytest.raises(BadValue, match="'Bob', allowed is one of naoenu, slt"):
        voices.voice("Bob", both)
    with pytest.raises(SpeechError, match="'naofrf' cannot speak: the engine espeak-ng is not installed"):
        voices.voice("naofrf", Installed("flite"))
    with pytest.raises(SpeechError, match="French cannot be spoken: the engine espeak-ng"):
        voices.language("French", Installed("flite"))
