"""Sentences of a text."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.speech.sentences import LONGEST, Sentence, sentences
from nao_sim_bridge.sim.speech.tags import Bookmark, Gate, Pause, TagReader


def cut(text):
    return [item.text for item in sentences(TagReader().read(text))]


@pytest.mark.parametrize(
    "text, expected",
    [
        ("Hello.", ["Hello."]),
        ("Hello. How are you? Fine!", ["Hello.", "How are you?", "Fine!"]),
        ("Dr. Smith is here. He waits.", ["Dr. Smith is here.", "He waits."]),
        ("J. S. Bach wrote it. Yes.", ["J. S. Bach wrote it.", "Yes."]),
        ("It costs 3.50 euros. See www.example.org now.", ["It costs 3.50 euros.", "See www.example.org now."]),
        ('He said "no." Then he left.', ['He said "no."', "Then he left."]),
        ("one line\nanother line", ["one line", "another line"]),
        ("こんにちは。元気ですか？はい", ["こんにちは。", "元気ですか？", "はい"]),
        (r"Hello my friends.\eos=0\How are you?", ["Hello my friends, How are you?"]),
        (r"Hello my friends \eos=1\how are you?", ["Hello my friends", "how are you?"]),
        (r"It is \vct=120\high\rst\. Is it?", ["It is high.", "Is it?"]),
        ("", []),
        ("  \n \n", []),
    ],
)
def test_sentences_end_where_a_reader_would_end_them(text, expected):
    assert cut(text) == expected


def test_nothing_of_a_long_text_is_lost_and_no_sentence_is_too_long():
    text = "word, " * 500 + "x" * 1000 + " end. " + "Short one. " * 600
    pieces = cut(text)
    assert max(map(len, pieces)) <= LONGEST
    assert "".join("".join(pieces).split()) == "".join(text.split())


def test_marks_stay_in_their_sentence():
    first, second = sentences(TagReader().read(r"One \mrk=1\ two. \pau=200\ Three \mrk=2\ "))
    assert [p for p in first.parts if isinstance(p, Bookmark)] == [Bookmark(1)]
    assert [p for p in second.parts if isinstance(p, (Bookmark, Pause))] == [Pause(0.2), Bookmark(2)]


def test_a_text_of_marks_alone_is_kept():
    (only,) = sentences([Bookmark(3)])
    assert only == Sentence((Bookmark(3),))


def test_a_gate_parts_a_sentence():
    gate = Gate(lambda: None)
    before, between, behind = sentences([*TagReader().read("Look at"), gate, *TagReader().read(" this.")])
    assert (before.text, between, behind.text) == ("Look at", gate, "this.")
