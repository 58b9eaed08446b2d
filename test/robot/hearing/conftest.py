"""A recogniser's ear, in this process."""

from __future__ import annotations

import pytest
from spoken_words import blocks

from nao_sim_bridge.hearing.grammars.grammar import vocabulary
from nao_sim_bridge.hearing.listening import Listening
from nao_sim_bridge.hearing.worker import Ear

PHRASES = ("yes", "no", "Stand up!", "room 21", "good morning", "red", "what is your name")


@pytest.fixture(scope="session")
def ear():
    return Ear()


@pytest.fixture
def heard(ear):
    """What the ear makes of a stream when it listens for phrases, or for grammars."""

    def hear(stream, phrases=PHRASES, grammars=None, hypotheses=1, **options):
        ear.listen(Listening(grammars or (vocabulary("v", list(phrases), **options),), hypotheses=hypotheses))
        ear.finish(None)
        return [event for block in blocks(stream) for event in ear.hear(block)]

    return hear
