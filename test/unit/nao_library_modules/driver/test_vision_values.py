"""Values of the robot's vision events, in the layouts of its documentation."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.vision_values import (
    Landmark,
    MovementReader,
    Shape,
    View,
    read_faces,
    read_landmarks,
)

STAMP = [12, 500000]
TORSO = [0.05, 0.01, 0.2, 0.0, 0.02, 0.5]
FEET = [0.06, 0.02, 0.5, 0.0, 0.03, 0.6]
LEFT_EYE = [0.01 * number for number in range(6)] + [0.0] * 8
RIGHT_EYE = [-0.01 * number for number in range(6)] + [0.0] * 8
NOSE = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
MOUTH = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6] + [0.0] * 10
EXTRA = [3, 0.75, "ada", LEFT_EYE, RIGHT_EYE, [], [], NOSE, MOUTH]


def faces(*entries, camera=1):
    return [STAMP, [*entries, [2, ["ada"]]], TORSO, FEET, camera]


def test_a_face_with_all_its_points():
    view, (face,) = read_faces(faces([[0, 0.1, -0.2, 0.15, 0.18], EXTRA]))
    assert view == View(12.5, 1, tuple(TORSO), tuple(FEET))
    assert face.shape == Shape(0.1, -0.2, 0.15, 0.18)
    assert (face.number, face.score, face.label) == (3, 0.75, "ada")
    assert face.points["left_eye_earSideLimit"] == (0.04, 0.05)
    assert face.points["right_eye_noseSideLimit"] == (-0.02, -0.03)
    assert face.points["nose_bottomRightLimit"] == (0.9, 1.0)
    assert face.points["mouth_topLimit"] == (0.5, 0.6)
    assert not any("eyebrow" in name for name in face.points)


def test_several_faces_and_what_is_new_about_them_is_no_face():
    second = [[0, -0.3, 0.0, 0.1, 0.1], [4, 0.0, ""]]
    _, found = read_faces(faces([[0, 0.1, -0.2, 0.15, 0.18], EXTRA], second))
    assert [(face.number, face.label) for face in found] == [(3, "ada"), (4, "")]
    assert found[1].points == {}


@pytest.mark.parametrize("value", [[], None, 0, [STAMP, [[]], TORSO, FEET, 0], [STAMP, [[4]], TORSO, FEET, 0], [STAMP]])
def test_no_face_is_none(value):
    assert read_faces(value) is None


def test_landmarks():
    marks = [[[1, 0.1, 0.2, 0.05, 0.06, 0.0], [84]], [[1, -0.1, 0.3, 0.07, 0.08, 0.0], [119]]]
    view, found = read_landmarks([STAMP, marks, TORSO, FEET, "CameraBottom"])
    assert (view.time, view.camera, view.in_robot) == (12.5, 1, tuple(FEET))
    assert found == [Landmark(Shape(0.1, 0.2, 0.05, 0.06), 84), Landmark(Shape(-0.1, 0.3, 0.07, 0.08), 119)]


def test_the_number_of_a_landmark_may_be_bare():
    _, (mark,) = read_landmarks([STAMP, [[[1, 0.1, 0.2, 0.05, 0.06, 0.0], 84]], TORSO, FEET, "CameraTop"])
    assert mark.number == 84


@pytest.mark.parametrize("value", [[], None, [STAMP, [], TORSO, FEET, "CameraTop"]])
def test_no_landmark_is_none(value):
    assert read_landmarks(value) is None


def movement(time, *clusters):
    return [[int(time), round(time % 1 * 1e6)], [list(cluster) for cluster in clusters], TORSO, FEET, 0]


def test_what_moved_and_how_fast_from_one_time_to_the_next():
    reader = MovementReader()
    first = reader.read(movement(5.0, ([0.2, 0.1], [0.25, 0.05, 0.1, 0.1], 0.5), ([-0.3, 0.0], [0, 0, 0.1, 0.1], 0.5)))
    assert first.points == ((0.2, 0.1), (-0.3, 0.0))
    assert first.centre == (pytest.approx(-0.05), pytest.approx(0.05))
    assert first.velocity == (0.0, 0.0) and first.velocities == ((0.0, 0.0), (0.0, 0.0))
    assert first.view == View(5.0, 0, tuple(TORSO), tuple(FEET))
    then = reader.read(movement(5.2, ([-0.3, 0.02], [0, 0, 0.1, 0.1], 0.5), ([0.3, 0.1], [0, 0, 0.1, 0.1], 0.5)))
    assert then.velocities == ((0.0, pytest.approx(0.1)), (pytest.approx(0.5), 0.0))
    assert then.velocity == (pytest.approx(0.25), pytest.approx(0.05))


def test_what_moves_more_counts_more():
    big, small = ([0.4, 0.0], [0, 0, 0.2, 0.2], 0.75), ([0.0, 0.0], [0, 0, 0.1, 0.1], 1.0)
    assert MovementReader().read(movement(5.0, big, small)).centre == (pytest.approx(0.3), 0.0)
    nothing = ([0.4, 0.0], [0, 0, 0.0, 0.0], 0.0)
    assert MovementReader().read(movement(5.0, nothing, nothing)).centre == (pytest.approx(0.4), 0.0)


def test_speeds_are_not_told_over_a_long_time_or_backwards():
    reader = MovementReader()
    for time in (5.0, 9.0, 2.0):
        found = reader.read(movement(time, ([time / 10, 0.0], [0, 0, 0.1, 0.1], 0.5)))
        assert found.velocities == ((0.0, 0.0),)


def test_the_layout_of_robots_before_2_0():
    value = [[[0.1, 0.2], [0.3, 0.4], [[0.1, 0.2], [0.5, 0.6]], [[0.3, 0.4], [0.7, 0.8]]]]
    found = MovementReader().read(value)
    assert (found.view, found.centre, found.velocity) == (None, (0.1, 0.2), (0.3, 0.4))
    assert found.points[1] == (0.5, 0.6) and found.velocities[1] == (0.7, 0.8)


@pytest.mark.parametrize("value", [[], None, 1, [STAMP, [], TORSO, FEET, 0]])
def test_no_movement_is_none(value):
    assert MovementReader().read(value) is None
