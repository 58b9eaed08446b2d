"""Faces are found, numbered, and have their eyes, nose and mouth where they are."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from face_pictures import CARD, FOCAL, OPTICS, face_picture, wall

from nao_sim_bridge.sim.faces import load_faces
from nao_sim_bridge.sim.vision.faces import FaceDetector, FaceSettings

PEOPLE = sorted(load_faces())


@pytest.fixture
def detector():
    return FaceDetector()


def find(detector, picture, time=0.0, **settings):
    return detector.detect(picture, OPTICS, FaceSettings(time, **settings))


@pytest.mark.parametrize("name", PEOPLE)
def test_a_face_is_found_from_half_a_metre_to_two(name, detector):
    for distance, yaw, light in [(0.5, 0.0, 1.0), (1.0, 0.25, 0.6), (1.5, -0.25, 1.2), (2.0, 0.0, 0.8)]:
        (face,) = find(detector, face_picture(name, distance, yaw, light=light), track=False)
        x, y, width, height = face.box
        assert (x + width / 2, y + height / 2) == pytest.approx((320, 240), abs=0.15 * FOCAL * CARD / distance)
        assert 0.4 < width / (FOCAL * CARD / distance) < 1.0


def test_an_empty_wall_has_no_face(detector):
    assert [find(detector, wall(seed).clip(0, 255).astype(np.uint8), 0.1 * seed) for seed in range(5)] == [[]] * 5


def test_nobody_is_blue(detector):
    picture = face_picture("ben", 1.0)
    assert len(find(detector, picture, track=False)) == 1
    assert find(detector, np.ascontiguousarray(picture[:, :, ::-1]), track=False) == []
    grey = np.repeat(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)[..., None], 3, axis=2)
    assert len(find(detector, grey, track=False)) == 1


def test_two_faces_are_two_the_larger_first(detector):
    picture = face_picture("anna", 1.2, place=(160, 240))
    picture = face_picture("hugo", 0.8, place=(460, 240), picture=picture)
    right, left = find(detector, picture)
    assert right.centre[0] < -0.1 < 0.1 < left.centre[0]
    assert right.size[0] > left.size[0]
    assert {right.number, left.number} == {1, 2}


@pytest.mark.parametrize("name", PEOPLE)
@pytest.mark.parametrize("distance", [0.6, 1.5])
def test_eyes_and_mouth_are_where_they_are_drawn(detector, name, distance):
    picture = face_picture(name, distance)
    (face,) = find(detector, picture)
    look = load_faces()[name]
    half, off = look.eyes[0], 0.55 if look.glasses == "square" else 0.25  # dark frames are taken for a part of the eye
    scale = FOCAL / distance
    left, right = (np.array(_pixel(points[0])) for points in (face.left_eye, face.right_eye))
    # Half the head is 0.32 of a card; eyes are as far apart as the look says.
    assert left[0] - right[0] == pytest.approx(2.0 * half * 0.32 * CARD * scale, rel=off)
    assert abs(left[1] - right[1]) < 0.12 * (left[0] - right[0])
    apart = left[0] - right[0]
    middle = (left + right) / 2.0
    mouth = np.array([_pixel(point) for point in face.mouth])
    nose = np.array([_pixel(point) for point in face.nose])
    assert abs(middle[0] - 320.0) < 0.15 * apart
    assert 0.7 < (mouth[:2, 1].mean() - middle[1]) / apart < 1.5
    assert middle[1] < nose[0, 1] < mouth[:2, 1].mean()
    assert mouth[0, 0] > mouth[1, 0] and nose[1, 0] > nose[2, 0]  # left is the person's own
    assert mouth[2, 1] <= mouth[0, 1]


def _pixel(angles):
    x, y = OPTICS.place(*angles)
    return 640.0 * x - 0.5, 480.0 * y - 0.5


def test_a_face_keeps_its_number_while_it_moves(detector):
    numbers = [
        find(detector, face_picture("emma", 1.0, place=(200 + 25 * step, 240)), 0.1 * step)[0].number
        for step in range(8)
    ]
    assert numbers == [1] * 8


def test_a_face_that_comes_back_later_has_another_number(detector):
    picture = face_picture("emma", 1.0)
    assert find(detector, picture, 0.0)[0].number == 1
    assert find(detector, picture, 0.9)[0].number == 1
    assert find(detector, picture, 3.0)[0].number == 2


def test_a_new_face_is_noticed_while_another_is_followed(detector):
    one = face_picture("ben", 1.0, place=(150, 240))
    two = face_picture("clara", 1.0, place=(480, 240), picture=one)
    find(detector, one, 0.0)
    assert [len(find(detector, two, time)) for time in (0.1, 0.2, 0.35)] == [1, 1, 2]
    assert len(find(detector, one, 0.4)) == 1


def test_without_tracking_every_picture_stands_alone(detector):
    picture = face_picture("ben", 1.0)
    assert [find(detector, picture, 0.1 * k, track=False)[0].number for k in range(3)] == [1, 2, 3]


def test_descriptions_are_made_when_they_are_wanted(detector):
    picture = face_picture("ben", 1.0)
    assert find(detector, picture, 0.0, describe=False)[0].description is None
    assert np.linalg.norm(find(detector, picture, 0.1)[0].description) == pytest.approx(1.0, abs=1e-3)


def test_another_size_of_picture_keeps_the_number(detector):
    picture = face_picture("grace", 1.0)
    assert find(detector, picture, 0.0)[0].number == 1
    small = cv2.resize(picture, (320, 240), interpolation=cv2.INTER_AREA)
    (face,) = find(detector, small, 0.1)
    assert face.number == 1
    assert face.box[2] == pytest.approx(0.5 * find(detector, picture, 0.2)[0].box[2], rel=0.25)
