"""What tests of speech share: the engines of this machine."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.speech.clips import ClipMaker, Style
from nao_sim_bridge.sim.speech.engines import Engines
from nao_sim_bridge.sim.speech.sentences import sentences
from nao_sim_bridge.sim.speech.tags import TagReader
from nao_sim_bridge.sim.speech.voices import load_voices


@pytest.fixture(scope="session")
def engines():
    """The speech process."""
    made = Engines()
    yield made
    made.close()


@pytest.fixture(scope="session")
def maker(engines):
    return ClipMaker(engines)


@pytest.fixture
def clips(maker):
    """Makes the clips of a text with tags; `style` as in `Style`, the voice by its name."""

    def make(text, voice="naoenu", **style):
        chosen = Style(load_voices().voices[voice], **style)
        return [maker.make(item, chosen) for item in sentences(TagReader().read(text, chosen.prosody))]

    return make


@pytest.fixture
def clip(clips):
    """Makes the clip of a text that is one sentence."""

    def make(*arguments, **options):
        (only,) = clips(*arguments, **options)
        return only

    return make
