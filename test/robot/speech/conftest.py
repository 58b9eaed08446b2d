"""What tests of speech share: the engines of this machine."""

from __future__ import annotations

import pytest

from nao_sim_bridge.speech.clips import ClipMaker, Style
from nao_sim_bridge.speech.engines import Engines
from nao_sim_bridge.speech.sentences import sentences
from nao_sim_bridge.speech.tags import TagReader
from nao_sim_bridge.speech.voices import load_voices


@pytest.fixture(scope="session")
def engines():
    """The speech process."""
    made = Engines()
    yield made
    made.close()


class CountingEngines:
    """Engines that count what they are asked for."""

    def __init__(self, engines):
        self._engines = engines
        self.asked = 0

    def synthesise(self, utterance):
        self.asked += 1
        return self._engines.synthesise(utterance)

    def __getattr__(self, name):
        return getattr(self._engines, name)


@pytest.fixture
def counting(engines):
    return CountingEngines(engines)


@pytest.fixture(scope="session")
def clip(engines):
    """Makes the clip of a text that is one sentence; `style` as in `Style`, the voice by its name."""
    shared = ClipMaker(engines)

    def make(text, voice="naoenu", maker=shared, **style):
        chosen = Style(load_voices().voices[voice], **style)
        (sentence,) = sentences(TagReader().read(text, chosen.prosody))
        return maker.make(sentence, chosen)

    return make
