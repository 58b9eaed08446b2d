"""What speaks for a phrase, from pieces made by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nao_sim_bridge.sim.hearing.everyday_speech import Piece, score_within, words_within
from nao_sim_bridge.sim.hearing.evidence import Evidence, evidence
from nao_sim_bridge.sim.hearing.settings import ConfidenceSettings, load_recognition

SETTINGS = ConfidenceSettings(bias=0.0, difference=3.0, everyday=1.0, sounds=1.0, same=1.0, length=1.0, least=0.4)


def word(text, phones, start, end, score):
    return Piece(text, tuple(phones.split()), start, end, score)


EVERYDAY = [
    Piece("<s>", (), 0, 9, -10.0),
    word("we", "W IY", 10, 19, -20.0),
    word("stand", "S T AE N D", 20, 39, -60.0),
    word("up", "AH P", 40, 49, -20.0),
]
SOUNDS = [Piece("S", ("S",), 0, 49, -50.0)]
STAND_UP = [word("stand-0", "S T AE N D", 20, 39, -60.0), word("up-1", "AH P", 40, 49, -20.0)]


def test_a_phrase_that_was_written_down_has_nothing_against_it():
    found = evidence(STAND_UP, ["stand", "up"], EVERYDAY, SOUNDS, inside=True)
    assert found.same and found.difference == 0.0 and found.everyday == pytest.approx(0.0)
    assert found.sounds == pytest.approx((-80.0 + 30.0) / 30)
    assert found.length == pytest.approx(7 / 9)


def test_a_phrase_that_sounds_different_says_so():
    found = evidence([word("no-0", "N OW", 20, 39, -100.0)], ["no"], EVERYDAY, SOUNDS, inside=True)
    assert not found.same and found.difference == 1.0
    assert found.everyday == pytest.approx(-40.0 / 20)


def test_figures_have_bounds():
    found = evidence([word("no-0", "N OW", 20, 39, -1e6)], ["no"], [], SOUNDS)
    assert (found.difference, found.everyday, found.sounds) == (1.0, -2.0, -5.0)
    assert evidence([word("no-0", "N OW", 0, 49, -1.0)], ["no"], EVERYDAY, SOUNDS).difference == 2.0


def test_other_words_count_against_a_whole_phrase():
    found = evidence(STAND_UP, ["stand", "up"], EVERYDAY, SOUNDS)
    assert not found.same and found.difference == pytest.approx(2 / 7)


def test_each_figure_moves_confidence_its_own_way():
    middle = Evidence(0.2, 0.0, -1.0, False, 0.5)
    sure = middle.confidence(SETTINGS)
    for better in ({"difference": 0.0}, {"everyday": 1.0}, {"sounds": 0.0}, {"same": True}, {"length": 1.0}):
        assert 1.0 >= replace(middle, **better).confidence(SETTINGS) > sure > 0.0


def test_scores_count_for_the_common_part():
    assert score_within(EVERYDAY, 15, 29) == pytest.approx(-10.0 - 30.0)
    assert score_within(EVERYDAY, 50, 80) == 0.0


def test_words_are_inside_for_the_most_part():
    assert [piece.word for piece in words_within(EVERYDAY, 14, 44)] == ["we", "stand", "up"]
    assert [piece.word for piece in words_within(EVERYDAY, 16, 43)] == ["stand"]
    assert [piece.word for piece in words_within(EVERYDAY, 25, 30)] == ["stand"]
    assert words_within(EVERYDAY, 0, 9) == []


@pytest.mark.parametrize("kind", ["confidence", "spotting"])
def test_the_weights_of_the_package_reject_what_sounds_quite_different(kind):
    settings = getattr(load_recognition(), kind)
    assert Evidence(1.0, -1.0, -3.0, False, 0.5).confidence(settings) < settings.least
    assert Evidence(0.0, 0.0, -1.0, True, 0.5).confidence(settings) > settings.least
