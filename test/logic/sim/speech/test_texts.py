"""Texts: tags in them, sentences, pronunciations of words."""

from __future__ import annotations

import time

import pytest

from nao_sim_bridge.speech.parameters import Pronunciations, Prosody
from nao_sim_bridge.speech.sentences import sentences
from nao_sim_bridge.speech.tags import Bookmark, Pause, Spoken, TagReader


@pytest.fixture
def warnings():
    return []


@pytest.fixture
def read(warnings):
    return TagReader(warnings.append).read


def spoken(pieces):
    return "".join(piece.text for piece in pieces if isinstance(piece, Spoken))


@pytest.mark.parametrize(
    "tag, expected",
    [
        (r"\rspd=200\ ", Prosody(speed=2.0)),
        (r"\vct=120\ ", Prosody(pitch=1.2)),
        (r"\vol=40\ ", Prosody(gain=0.5)),
        (r"\style=joyful\ ", Prosody(1.05, 1.12)),
        (r"\rspd=200\\vct=150\ ", Prosody(2.0, 1.5)),
        (r"\rspd= 200 \ ", Prosody(speed=2.0)),
        (r"\rspd=200 ", Prosody(speed=2.0)),
    ],
)
def test_a_tag_changes_what_comes_behind_it(read, warnings, tag, expected):
    first, *_, last = read(f"before {tag}behind")
    assert (first.prosody, last.prosody) == (Prosody(), expected)
    assert not warnings


def test_values_beyond_a_limit_are_taken_for_it_and_told_once(read, warnings):
    for _ in range(2):
        *_, last = read(r"\rspd=10\ \vct=900\ \vol=150\ loud")
        assert last.prosody == Prosody(0.5, 2.0, 1.25)
    told = [r"tag \rspd=10\ is taken for 50", r"tag \vct=900\ is taken for 200", r"tag \vol=150\ is taken for 100"]
    assert [text.split(",")[0] for text in warnings] == told


def test_tags_change_the_parameters_by_their_share_until_a_reset(read):
    assert read("Hello there.") == [Spoken("Hello there.", Prosody())] and read("") == []
    (piece,) = read(r"\rspd=50\quick", Prosody(speed=3.0, pitch=1.5))
    assert piece.prosody == Prosody(1.5, 1.5)
    (piece,) = read(r"\rspd=400\quick", Prosody(speed=3.0))
    assert piece.prosody.speed == 4.0
    pieces = read(r"\rspd=50\\vct=150\\vol=10\\style=didactic\slow \rst\ as before", Prosody(speed=1.2))
    assert pieces[-1].prosody == Prosody(speed=1.2)


def test_pauses_and_bookmarks_stand_where_they_are_written(read):
    pieces = read(r"one \pau=500\ two \mrk=7\ three \wait=3\ ")
    marks = [piece for piece in pieces if not isinstance(piece, Spoken)]
    assert marks == [Pause(0.5), Bookmark(7), Pause(pytest.approx(0.6))]
    assert isinstance(pieces[1], Pause) and isinstance(pieces[3], Bookmark)


def test_spelling_parts_the_letters_and_phonetic_text_is_not_spoken(read, warnings):
    assert spoken(read(r"a \tn=spell\NAO 6\tn=normal\ robot")).split() == ["a", "N,", "A,", "O,", "6", "robot"]
    assert spoken(read(r"\readmode=char\ab\readmode=sent\ cd")).split() == ["a,", "b", "cd"]
    assert not warnings
    assert spoken(read(r"my name is \toi=lhp\E'mil\toi=orth\ indeed")).split() == ["my", "name", "is", "indeed"]
    assert len(warnings) == 1


@pytest.mark.parametrize(
    "text",
    [
        r"\emph=2\very \emph=1\good",
        r"\rspd=fast\very \vct=abc\good",
        r"\mrk=70000\very \pau=-5\good",
        r"very \audio=/usr/share/a.wav\good",
        "very\\ good\\",
    ],
)
def test_what_cannot_be_followed_is_never_spoken(read, text):
    pieces = read(text)
    assert spoken(pieces).split() == ["very", "good"]
    assert all(piece.prosody == Prosody() for piece in pieces)


@pytest.mark.parametrize(
    "text, expected",
    [
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
        ("  \n \n", []),
    ],
)
def test_sentences_end_where_a_reader_would_end_them(text, expected):
    assert [item.text for item in sentences(TagReader().read(text))] == expected


@pytest.mark.parametrize("part", ["\\a= ", " ", ".", ". ", "\\a", "Dr. ", "\\eos=0\\.", '"'])
def test_a_long_text_takes_no_longer_than_it_should(part):
    began = time.process_time()
    sentences(TagReader(lambda _: None).read(part * (5000 // len(part))))
    sentences(TagReader(lambda _: None).read("\\a=" + part * (5000 // len(part)) + "x"))
    assert time.process_time() - began < 1.0


def test_whole_words_are_replaced_and_places_lead_back_to_the_text_as_it_is_written():
    names = Pronunciations().with_entry("Nao", "now").with_entry("H25", "h twenty five")
    text, _ = names.spoken("NAO is a nao, Naomi is not. An h25!")
    assert text == "now is a now, Naomi is not. An h twenty five!"
    written = "a H25 here"
    text, origins = names.spoken(written)
    assert len(origins) == len(text)
    for part_spoken, part in (("a", "a"), ("h twenty", "H25"), ("five", "H25"), ("here", "h")):
        first, end = origins[text.index(part_spoken)]
        assert written[first:end] == part
    again = names.with_entry("NAO", "noah")
    assert again.spoken("Nao")[0] == "noah"
    assert not again.without("nao").knows("Nao") and again.without("nao").spoken("Nao")[0] == "Nao"
