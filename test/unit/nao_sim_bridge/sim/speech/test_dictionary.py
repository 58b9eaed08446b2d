"""Pronunciations of words."""

from __future__ import annotations

from nao_sim_bridge.sim.speech.dictionary import Pronunciations

NAMES = Pronunciations().with_entry("Nao", "now").with_entry("H25", "h twenty five")


def test_whole_words_are_replaced_whatever_their_capitals():
    text, _ = NAMES.spoken("NAO is a nao, Naomi is not. An h25!")
    assert text == "now is a now, Naomi is not. An h twenty five!"


def test_places_lead_back_to_the_text_as_it_is_written():
    written = "a H25 here"
    text, origins = NAMES.spoken(written)
    assert len(origins) == len(text)
    for spoken, part in (("a", "a"), ("h twenty", "H25"), ("five", "H25"), ("here", "h")):
        first, end = origins[text.index(spoken)]
        assert written[first:end] == part


def test_a_newer_entry_replaces_an_older_one():
    again = NAMES.with_entry("NAO", "noah")
    assert again.spoken("Nao")[0] == "noah"
    assert not again.without("nao").knows("Nao")
    assert again.without("nao").spoken("Nao")[0] == "Nao"
