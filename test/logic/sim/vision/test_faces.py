"""Faces are found and told apart; known people and what is told of them only once."""

from __future__ import annotations

from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from face_pictures import CARD, FOCAL, OPTICS, face_picture, wall

from nao_sim_bridge.naoqi.vision.face_detection_value import NamedFace, NamesOnce
from nao_sim_bridge.vision.face_memory import MOST_PICTURES, FaceFileError, FaceMemory
from nao_sim_bridge.vision.faces import FaceDetector, FaceSettings
from nao_sim_bridge.world.painting.known_faces import load_faces

PEOPLE = sorted(load_faces())


@pytest.fixture
def detector():
    return FaceDetector()


def find(detector, picture, time=0.0, **settings):
    return detector.detect(picture, OPTICS, FaceSettings(time, **settings))


def pixel(angles):
    x, y = OPTICS.place(*angles)
    return np.array((640.0 * x - 0.5, 480.0 * y - 0.5))


@pytest.mark.parametrize("name", PEOPLE)
def test_a_face_is_found_with_its_eyes_nose_and_mouth(name, detector):
    for distance, yaw, light in [(0.5, 0.0, 1.0), (1.0, 0.25, 0.6), (1.5, -0.25, 1.2), (2.0, 0.0, 0.8)]:
        (face,) = find(detector, face_picture(name, distance, yaw, light=light), track=False)
        x, y, width, height = face.box
        assert (x + width / 2, y + height / 2) == pytest.approx((320, 240), abs=0.15 * FOCAL * CARD / distance)
        assert 0.4 < width / (FOCAL * CARD / distance) < 1.0
    for distance in (0.6, 1.5):
        (face,) = find(detector, face_picture(name, distance), track=False)
        look = load_faces()[name]
        # Dark frames are taken for a part of the eye.
        half, off = look.eyes[0], 0.55 if look.glasses == "square" else 0.25
        left, right = pixel(face.left_eye[0]), pixel(face.right_eye[0])
        # Half the head is 0.32 of a card; eyes are as far apart as the look says.
        assert left[0] - right[0] == pytest.approx(2.0 * half * 0.32 * CARD * FOCAL / distance, rel=off)
        apart, middle = left[0] - right[0], (left + right) / 2.0
        assert abs(left[1] - right[1]) < 0.12 * apart and abs(middle[0] - 320.0) < 0.15 * apart
        mouth, nose = (np.array([pixel(point) for point in points]) for points in (face.mouth, face.nose))
        assert 0.7 < (mouth[:2, 1].mean() - middle[1]) / apart < 1.5
        assert middle[1] < nose[0, 1] < mouth[:2, 1].mean() and mouth[2, 1] <= mouth[0, 1]
        assert mouth[0, 0] > mouth[1, 0] and nose[1, 0] > nose[2, 0]  # left is the person's own


def test_a_wall_has_no_face_and_nobody_is_blue(detector):
    assert [find(detector, wall(seed).clip(0, 255).astype(np.uint8), 0.1 * seed) for seed in range(5)] == [[]] * 5
    picture = face_picture("ben", 1.0)
    grey = np.repeat(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)[..., None], 3, axis=2)
    blue = np.ascontiguousarray(picture[:, :, ::-1])
    assert [len(find(detector, seen, track=False)) for seen in (picture, grey, blue)] == [1, 1, 0]


def describe(*arguments, **options):
    faces = find(FaceDetector(), face_picture(*arguments, **options))
    return faces[0].description if faces else None


def test_known_people_are_told_apart_and_strangers_stay_unknown():
    memory, known = FaceMemory(), ("anna", "ben", "clara", "david", "emma", "farid")
    assert memory.recognise(np.ones(8)) == ("", 0.0)
    for name in known:
        memory.learn(name, describe(name, 1.0, seed=1))
    for distance, yaw, light in ((0.6, 0.0, 1.2), (1.0, 0.2, 1.0), (1.4, -0.1, 0.7), (2.0, 0.0, 1.0)):
        guesses = [memory.recognise(describe(name, distance, yaw, light=light, seed=2)) for name in known]
        told = [guess if score >= 0.4 else "" for guess, score in guesses]
        assert all(guess in (name, "") for name, guess in zip(known, told)) and told.count("") <= 1
    for name in ("grace", "hugo"):
        assert max(memory.recognise(describe(name, d, seed=3))[1] for d in (0.7, 1.2, 1.8)) < 0.4


def direction(number):
    return np.eye(8, dtype=np.float32)[number]


def test_more_pictures_make_more_of_a_person_known_up_to_ten():
    memory = FaceMemory()
    memory.learn("a", direction(0))
    assert memory.recognise(direction(1)) == ("", 0.0)
    memory.learn("a", direction(1))
    assert memory.recognise(direction(1)) == ("a", 1.0)
    assert [memory.learn("a", direction(0)) for _ in range(9)] == [True] * (MOST_PICTURES - 2) + [False]
    assert memory.pictures_of("a") == MOST_PICTURES == 10 and memory.names == ["a"]
    assert memory.forget("a") and not memory.forget("a") and memory.names == []


def test_a_file_gives_back_what_was_saved_and_broken_ones_are_errors(tmp_path):
    memory, path = FaceMemory(), tmp_path / "faces.npz"
    for number, name in enumerate(["anna", "bjørn", "anna"]):
        memory.learn(name, direction(number))
    memory.save(path)
    again = FaceMemory.load(path)
    assert (again.names, again.pictures_of("anna")) == (["anna", "bjørn"], 2)
    assert again.recognise(direction(1)) == ("bjørn", 1.0) and list(tmp_path.iterdir()) == [path]
    FaceMemory().save(path)
    assert FaceMemory.load(path).names == []
    for content in (b"", b"not an archive", b"PK\x03\x04 broken"):
        path.write_bytes(content)
        with pytest.raises(FaceFileError, match="faces.npz' is"):
            FaceMemory.load(path)


@pytest.mark.parametrize("policy, pictures", [("overwrite", (0, 1)), ("merge", (1, 1)), ("keep", (1, 0))])
def test_policies_for_people_whom_both_know(policy, pictures):
    mine, other = FaceMemory(), FaceMemory()
    for memory, name, number in ((mine, "a", 0), (other, "a", 1), (other, "b", 2)):
        memory.learn(name, direction(number))
    mine.take_over(other, policy)
    assert mine.names == ["a", "b"]
    assert tuple(round(mine.recognise(direction(number))[1]) for number in (0, 1)) == pictures


def face(name="", number=1):
    return NamedFace(SimpleNamespace(number=number), name, 0.5)


def test_who_comes_is_told_once_and_again_after_four_seconds_without_a_face():
    names, both = NamesOnce(), [face("anna", 1), face("ben", 2)]
    assert names.news(both, 0.0) == [3, ["anna", "ben"]]
    assert names.news([*both, face("clara", 3)], 0.1) == [2, ["clara"]]
    assert [names.news(both, 0.1 * k) for k in range(2, 5)] == [[]] * 3
    names.news([], 4.3)
    assert names.news([face("anna")], 4.35) == []
    names.news([], 8.4)
    assert names.news([face("anna")], 8.5) == [2, ["anna"]]
    for time in range(9, 20):
        names.news([face("", 2)], float(time))
    assert names.news([face("anna")], 20.0) == [], "somebody else was in view"


def test_a_stranger_is_told_once_after_eight_seconds_in_view():
    names = NamesOnce()
    assert [time for time in range(12) if names.news([face("")], float(time)) == [4]] == [9]


@pytest.mark.parametrize("meanwhile, later", [([face("anna")], (8, 9, 10)), (None, (9.5, 10.0))])
def test_a_stranger_who_is_recognised_or_goes_away_meanwhile_begins_anew(meanwhile, later):
    names = NamesOnce()
    for time in range(7):
        names.news([face("")], float(time))
    if meanwhile:
        names.news(meanwhile, 7.0)
    assert [names.news([face("")], float(time)) for time in later] == [[]] * len(later)
