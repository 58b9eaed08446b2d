"""Text with tags, read into pieces."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.speech.parameters import Prosody
from nao_sim_bridge.sim.speech.tags import TAG, Bookmark, Pause, Spoken, TagReader


@pytest.fixture
def warnings():
    return []


@pytest.fixture
def read(warnings):
    return TagReader(warnings.append).read


def spoken(pieces):
    return "".join(piece.text for piece in pieces if isinstance(piece, Spoken))


def test_text_without_tags_is_one_piece(read):
    assert read("Hello there.") == [Spoken("Hello there.", Prosody())]
    assert read("") == []


@pytest.mark.parametrize(
    "tag, expected",
    [
        (r"\rspd=200\ ", Prosody(speed=2.0)),
        (r"\rspd=50\ ", Prosody(speed=0.5)),
        (r"\vct=120\ ", Prosody(pitch=1.2)),
        (r"\vol=40\ ", Prosody(gain=0.5)),
        (r"\vol=100\ ", Prosody(gain=1.25)),
        (r"\style=joyful\ ", Prosody(1.05, 1.12)),
        (r"\rspd=200\\vct=150\ ", Prosody(2.0, 1.5)),
        (r"\RSPD=200\ ", Prosody(speed=2.0)),
        (r"\rspd= 200 \ ", Prosody(speed=2.0)),
        (r"\rspd=200 ", Prosody(speed=2.0)),
        (r"\rspd=200 \vct=150\ ", Prosody(2.0, 1.5)),
    ],
)
def test_a_tag_changes_what_comes_behind_it(read, warnings, tag, expected):
    first, *_, last = read(f"before {tag}behind")
    assert (first.prosody, last.prosody) == (Prosody(), expected)
    assert not warnings


def test_tags_change_the_parameters_by_their_share(read):
    (piece,) = read(r"\rspd=50\quick", Prosody(speed=3.0, pitch=1.5))
    assert piece.prosody == Prosody(1.5, 1.5)
    (piece,) = read(r"\rspd=400\quick", Prosody(speed=3.0))
    assert piece.prosody.speed == 4.0


def test_reset_brings_back_the_parameters(read):
    pieces = read(r"\rspd=50\\vct=150\\vol=10\\style=didactic\slow \rst\ as before", Prosody(speed=1.2))
    assert pieces[-1].prosody == Prosody(speed=1.2)


def test_pauses_and_bookmarks_stand_where_they_are_written(read):
    pieces = read(r"one \pau=500\ two \mrk=7\ three \wait=3\ ")
    assert [piece for piece in pieces if not isinstance(piece, Spoken)] == [
        Pause(0.5),
        Bookmark(7),
        Pause(pytest.approx(0.6)),
    ]
    assert isinstance(pieces[1], Pause) and isinstance(pieces[3], Bookmark)


def test_spelling_parts_the_letters(read):
    assert spoken(read(r"a \tn=spell\NAO 6\tn=normal\ robot")).split() == ["a", "N,", "A,", "O,", "6", "robot"]
    assert spoken(read(r"\readmode=char\ab\readmode=sent\ cd")).split() == ["a,", "b", "cd"]


def test_phonetic_text_is_not_spoken(read, warnings):
    assert spoken(read(r"my name is \toi=lhp\E'mil\toi=orth\ indeed")).split() == ["my", "name", "is", "indeed"]
    assert len(warnings) == 1


@pytest.mark.parametrize(
    "text",
    [
        r"\emph=2\very \emph=1\good",
        r"\foo=bar\very \nonsense\good",
        r"\rspd=1000\very \vct=abc\good",
        r"\mrk=70000\very \pau=-5\good",
        r"very \audio=/usr/share/a.wav\good",
        r'very \audio="/usr/my share/a.wav"\good',
        r"very \ good",
        "very\\ good\\",
    ],
)
def test_what_cannot_be_followed_is_never_spoken(read, text):
    pieces = read(text)
    assert spoken(pieces).split() == ["very", "good"]
    assert all(piece.prosody == Prosody() for piece in pieces)


def test_a_tag_that_is_left_out_is_told_once(read, warnings):
    read(r"\emph=2\one \emph=1\two")
    read(r"\emph=0\three")
    assert len(warnings) == 1 and "emph" in warnings[0]


def test_tags_of_a_long_text_do_not_take_long():
    assert len(TAG.findall("\\" * 20000)) == 0
