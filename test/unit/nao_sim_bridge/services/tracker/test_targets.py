"""What events of the extractors say about places."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.services.tracker.looking import robot_position
from nao_sim_bridge.services.tracker.targets import (
    TARGETS,
    Parameters,
    read_ball,
    read_faces,
    read_landmarks,
    read_sound,
)
from nao_sim_bridge.sim.errors import SimulationError

CAMERA = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]
ONE_METRE = 2.0 * math.atan(0.05)
"""Angle under which 0.1 m are seen a metre away, rad."""


def test_a_ball_is_as_far_as_its_radius_says():
    value = [[1, 0], [0.0, 0.0, ONE_METRE / 2.0, ONE_METRE / 2.0], CAMERA, CAMERA, 0]
    (ball,) = read_ball(value, Parameters(0.1))
    assert ball.place == pytest.approx((1.0, 0.0, 0.5), abs=1e-6)
    assert read_ball([], Parameters(0.1)) == []


def face(number, width):
    return [[0, 0.0, 0.0, width, width], [number, 0.0, "", [], [], [], [], [], []]]


def test_the_nearest_face_comes_first_and_ids_choose():
    value = [[1, 0], [face(1, 0.1), face(2, 0.2), []], CAMERA, CAMERA, 0]
    assert [f.number for f in read_faces(value, Parameters(0.15))] == [2, 1]
    assert [f.number for f in read_faces(value, Parameters(0.15, (1,)))] == [1]
    assert read_faces([], Parameters(0.15)) == []


def test_a_mark_from_the_side_is_as_far_as_from_the_front():
    def mark(width):
        return [[1, 0.0, 0.0, width, ONE_METRE, 0.0], [64]]

    value = [[1, 0], [mark(ONE_METRE), mark(ONE_METRE / 2.0)], CAMERA, CAMERA, "CameraTop"]
    front, side = read_landmarks(value, Parameters(0.1))
    assert front.distance == side.distance == pytest.approx(1.0)
    assert read_landmarks(value, Parameters(0.1, (80,))) == []


def test_a_sound_has_a_direction_and_counts_when_it_is_sure():
    value = [[1, 0], [math.pi / 2.0 - 0.2, 0.3, 0.6, 0.0], CAMERA, CAMERA]
    (sound,) = read_sound(value, Parameters(2.0, (), 0.5))
    assert math.dist(sound.place, CAMERA[:3]) == pytest.approx(2.0)
    assert sound.place[1] > 1.5
    assert sound.place[2] > 0.5
    assert read_sound(value, Parameters(2.0, (), 0.7)) == []


@pytest.mark.parametrize(
    "target, given, wanted",
    [
        ("RedBall", 0.06, Parameters(0.06)),
        ("Face", [0.2], Parameters(0.2)),
        ("LandMark", [0.1, [64, 80]], Parameters(0.1, (64, 80))),
        ("Sound", [1.5, 0.4], Parameters(1.5, (), 0.4)),
        ("People", [3, 4], Parameters(0.15, (3, 4))),
    ],
)
def test_parameters_as_naoqi_takes_them(target, given, wanted):
    assert TARGETS[target].parameters(given) == wanted


@pytest.mark.parametrize("target, given", [("RedBall", "big"), ("LandMark", 0.1), ("Sound", [1.0]), ("People", [-1])])
def test_other_parameters_are_refused(target, given):
    with pytest.raises(SimulationError):
        TARGETS[target].parameters(given)


def test_two_known_marks_tell_where_the_robot_is():
    # It is at (1, 2) and looks to the left.
    seen = [(1.0, 0.5, 0.4), (2.0, -0.5, 0.3)]
    known = [(0.5, 3.0, 0.4), (1.5, 4.0, 0.3)]
    assert robot_position(seen, known) == pytest.approx([1.0, 2.0, math.pi / 2.0])
    assert robot_position(seen[:1], known[:1]) == []
