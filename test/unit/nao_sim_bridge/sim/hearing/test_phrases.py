"""Phrases as people write them become words as people say them."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.hearing.phrases import spoken_words


@pytest.mark.parametrize(
    "phrase, words",
    [
        ("Stand up!", "stand up"),
        ("  I don’t KNOW. ", "i don't know"),
        ("good-morning", "good morning"),
        ("room 21", "room twenty one"),
        ("3.5 metres", "three point five metres"),
        ("the 2nd and 30th", "the second and thirtieth"),
        ("1,234", "one thousand two hundred thirty four"),
        ("007", "zero zero seven"),
        ("50% of it", "fifty percent of it"),
        ("salt & pepper", "salt and pepper"),
        ("the U.S.A.", "the u s a"),
        ("café", "café"),
    ],
)
def test_words_are_spoken(phrase, words):
    assert spoken_words(phrase) == words.split()


@pytest.mark.parametrize("phrase", ["", "   ", "?!", "..."])
def test_a_phrase_without_words_is_refused(phrase):
    with pytest.raises(BadValue, match="at least one word"):
        spoken_words(phrase)
