"""Faces on stand-ins: who is seen, who is learnt."""

from __future__ import annotations

import math

import pytest
from fake_seeing import HFOV
from seeing_goals import FACES, abort, f, face, faces_value, succeed


def test_faces_with_and_without_names(vision, eyes, clock):
    clock.script = [
        lambda: eyes.raise_event(FACES, []),
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(3, "anna", 0.8, 0.2), face(4, "", 0.0, -0.2))),
    ]
    result = succeed(vision, f("detectFaces"))
    anna, other = result.objects
    assert result.memList == ["anna", "face"]
    assert (anna.name, anna.confidence, anna.kind, other.name) == ("anna", 0.8, "face", "")
    assert anna.width == pytest.approx(math.tan(0.1) / math.tan(HFOV / 2))
    depth = 0.16 / (2.0 * math.tan(0.1)) / math.cos(0.2)
    assert (anna.camera_position.x, anna.camera_position.z) == pytest.approx((-depth * math.tan(0.2), depth))
    assert eyes.idle()


def test_who_is_recognised_with_less_than_asked_for_is_somebody(vision, eyes, clock):
    clock.script = [lambda: eyes.raise_event(FACES, faces_value(eyes, face(3, "anna", 0.5)))] * 2
    result = succeed(vision, f("detectFaces", confidence=0.6), f("detectFaces", confidence=0.4))
    assert [o.name for o in result.objects] == ["", "anna"]


def test_only_the_person_that_is_asked_for(vision, eyes, clock):
    clock.script = [
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(3, "ben", 0.9))),
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(3, "ben", 0.9), face(4, "anna", 0.9, 0.3))),
    ]
    (anna,) = succeed(vision, f("detectFaces", str_param="anna")).objects
    assert (anna.name, anna.alpha) == ("anna", 0.3)
    assert clock.time == pytest.approx(100.2)


def test_a_face_that_is_known_in_some_pictures_is_known(vision, eyes, clock):
    clock.script = [
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(3, "", 0.0, 0.1))),
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(3, "anna", 0.7, 0.2))),
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(3, "", 0.0, 0.3), recognised=[2, ["anna"]])),
    ]
    (anna,) = succeed(vision, f("detectFaces", count=3)).objects
    assert (anna.name, anna.looks, anna.alpha) == ("anna", 3, 0.2)


def test_a_face_that_nobody_knows_for_long_is_no_face_more(vision, eyes, clock):
    clock.script = [lambda: eyes.raise_event(FACES, faces_value(eyes, face(3), recognised=[4]))]
    assert succeed(vision, f("detectFaces")).memList == ["face"]


def test_a_face_is_learnt_as_soon_as_it_is_alone_and_good_enough(vision, eyes, clock):
    eyes.faces.refuse = 1
    clock.script = [
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(1), face(2))),
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(1, "", 0.0, 0.2))),
        lambda: eyes.raise_event(FACES, faces_value(eyes, face(1, "", 0.0, 0.1))),
    ]
    result = succeed(vision, f("learnFace", str_param=" anna ", timeout=5.0), f("listFaces"))
    assert result.memList == ["True", "anna"]
    assert [(o.name, o.alpha) for o in result.objects] == [("anna", 0.1)]
    assert eyes.faces.calls == [("learnFace", "anna")] * 2 and clock.time == pytest.approx(100.3)
    assert eyes.idle()


def test_no_face_to_learn_is_an_answer(vision, eyes, clock):
    result = succeed(vision, f("learnFace", str_param="anna", timeout=2.0), f("getLearnedFaces"))
    assert (result.memList, result.objects, clock.time) == (["False"], [], pytest.approx(102.0))
    assert eyes.faces.calls == [] and eyes.idle()


def test_people_are_forgotten(vision, eyes):
    eyes.faces.learnt = ["anna", "ben", "clara"]
    assert succeed(vision, f("forgetFace", str_param="ben"), f("listFaces")).memList == ["anna", "clara"]
    assert succeed(vision, f("forgetAllFaces"), f("listFaces")).memList == []


def test_who_is_learnt_already_is_added_to_and_not_learnt_again(vision, eyes, clock):
    eyes.faces.learnt = ["anna"]
    assert "reLearnFace" in abort(vision, f("learnFace", str_param="anna"))
    clock.script = [lambda: eyes.raise_event(FACES, faces_value(eyes, face(1)))]
    assert succeed(vision, f("reLearnFace", str_param="anna")).memList == ["True"]
    assert eyes.faces.calls == [("reLearnFace", "anna")]


@pytest.mark.parametrize("function", ["reLearnFace", "forgetFace"])
def test_who_is_not_learnt_is_told_with_those_who_are(vision, eyes, function):
    eyes.faces.learnt = ["anna"]
    text = abort(vision, f(function, str_param="ana"))
    assert "'ana'" in text and "learnt are anna" in text
