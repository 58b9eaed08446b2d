"""What `FaceDetected` tells only once: names of people who come, and somebody unknown who stays."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_sim_bridge.services.vision.face_detection_value import NamedFace, NamesOnce


def face(name="", number=1):
    return NamedFace(SimpleNamespace(number=number), name, 0.5)


@pytest.fixture
def names():
    return NamesOnce()


def test_a_name_is_told_once(names):
    assert names.news([face("anna")], 0.0) == [2, ["anna"]]
    assert [names.news([face("anna")], 0.1 * k) for k in range(1, 5)] == [[]] * 4


def test_several_who_come_together_are_told_together_and_each_once(names):
    both = [face("anna", 1), face("ben", 2)]
    assert names.news(both, 0.0) == [3, ["anna", "ben"]]
    assert names.news([*both, face("clara", 3)], 0.1) == [2, ["clara"]]


def test_who_comes_again_is_told_again_after_four_seconds_without_a_face(names):
    names.news([face("anna")], 0.0)
    names.news([], 3.9)
    assert names.news([face("anna")], 3.95) == []
    names.news([], 8.0)
    assert names.news([face("anna")], 8.1) == [2, ["anna"]]


def test_somebody_else_in_view_keeps_names_from_being_told_again(names):
    names.news([face("anna")], 0.0)
    for time in range(1, 10):
        names.news([face("", 2)], float(time))
    assert names.news([face("anna")], 10.0) == []


def test_a_stranger_is_told_once_after_eight_seconds(names):
    told = [time for time in range(12) if names.news([face("")], time / 1.0) == [4]]
    assert told == [9]


def test_a_stranger_who_is_recognised_meanwhile_is_none(names):
    for time in range(7):
        names.news([face("")], float(time))
    names.news([face("anna")], 7.0)
    assert [names.news([face("")], float(time)) for time in (8, 9, 10)] == [[], [], []]


def test_a_stranger_who_went_away_begins_anew(names):
    for time in range(7):
        names.news([face("")], float(time))
    assert names.news([face("")], 9.5) == []
