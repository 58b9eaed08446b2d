"""Red balls in drawn pictures: where they are, how far, and what is no ball."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from seen_cards import GREY, OPTICS, sphere

from nao_sim_bridge.sim.vision.ball import BallDetector, red_parts

RED, ORANGE, BROWN, PINK = (20, 25, 215), (20, 130, 235), (55, 85, 140), (150, 90, 230)


@pytest.fixture(scope="module")
def detector():
    return BallDetector()


def shape(draw, color=RED, size=(320, 240)):
    """A picture with what `draw(picture, color)` draws, with smooth edges."""
    fine = np.empty((4 * size[1], 4 * size[0], 3), np.uint8)
    fine[:] = GREY
    draw(fine, color)
    return cv2.resize(fine, size, interpolation=cv2.INTER_AREA)


def test_redness_is_the_same_in_light_and_shadow():
    light, shadow = np.uint8([[[20, 30, 200]]]), np.uint8([[[10, 15, 100]]])
    assert red_parts(light, 40.0)[1] == pytest.approx(red_parts(shadow, 40.0)[1])
    assert red_parts(light, 40.0)[0] == pytest.approx(170.0)


@pytest.mark.parametrize("radius", [0.03, 0.05])
@pytest.mark.parametrize("distance", [0.3, 1.0, 2.0])
@pytest.mark.parametrize("alpha, beta", [(0.0, 0.0), (0.3, 0.2), (-0.25, -0.15)])
def test_a_ball_is_found_where_it_is(detector, radius, distance, alpha, beta):
    (ball,) = detector.detect(sphere(distance, radius, alpha, beta), OPTICS)
    assert ball.alpha == pytest.approx(alpha, abs=math.radians(0.2))
    assert ball.beta == pytest.approx(beta, abs=math.radians(0.2))
    assert ball.radius == pytest.approx(math.asin(radius / distance), rel=0.05)
    assert ball.distance(radius) == pytest.approx(distance, rel=0.05)
    x, y = OPTICS.place(alpha, beta)
    assert (ball.x, ball.y) == pytest.approx((x, y), abs=0.005)


@pytest.mark.parametrize("back", [(30, 30, 30), (60, 100, 150), (240, 240, 240)], ids=["dark", "wood", "white"])
def test_what_is_behind_makes_no_difference(detector, back):
    (ball,) = detector.detect(sphere(1.0, 0.03, back=back), OPTICS)
    assert ball.distance(0.03) == pytest.approx(1.0, rel=0.05)


def test_a_dark_room_makes_no_difference(detector):
    picture = (sphere(1.0, 0.05, 0.1, 0.1, noise=0.0) * 0.3).astype(np.uint8)
    (ball,) = detector.detect(picture, OPTICS)
    assert (ball.alpha, ball.beta) == pytest.approx((0.1, 0.1), abs=0.005)


@pytest.mark.parametrize("edge", ["left", "right", "bottom", "corner"])
def test_a_ball_that_the_edge_of_the_picture_cuts_is_found_where_it_is(detector, edge):
    across, down = (field / 2.0 for field in OPTICS.fov)
    alpha, beta = {
        "left": (across - 0.01, 0.1),
        "right": (-across + 0.01, -0.1),
        "bottom": (0.1, down - 0.01),
        "corner": (across - 0.03, down - 0.03),
    }[edge]
    (ball,) = detector.detect(sphere(0.6, 0.05, alpha, beta), OPTICS)
    assert ball.alpha == pytest.approx(alpha, abs=math.radians(0.5))
    assert ball.beta == pytest.approx(beta, abs=math.radians(0.5))
    assert ball.distance(0.05) == pytest.approx(0.6, rel=0.05)


def test_the_better_of_two_balls_comes_first(detector):
    cut, whole = sphere(0.6, 0.05, OPTICS.hfov / 2.0 - 0.02, 0.0, noise=0.0), sphere(0.6, 0.05, -0.2, 0.0, noise=0.0)
    both = np.where((cut[..., 2] > 90)[..., None] & (cut[..., :1] < 60), cut, whole)
    first, second = detector.detect(both, OPTICS)
    assert first.alpha == pytest.approx(-0.2, abs=0.005)
    assert second.alpha == pytest.approx(OPTICS.hfov / 2.0 - 0.02, abs=0.01)
    assert first.quality > second.quality


def test_a_ball_in_front_of_something_red_is_found(detector):
    chair = np.where(np.arange(240)[:, None, None] < 120, np.uint8([[[46, 51, 158]]]), np.uint8([[GREY]]))
    ball = sphere(0.8, 0.05, 0.1, 0.0, noise=0.0)
    there = (ball[..., 2].astype(int) - ball[..., 0] > 40)[..., None]
    (found,) = detector.detect(np.where(there, ball, np.broadcast_to(chair, ball.shape)), OPTICS)
    assert (found.alpha, found.beta) == pytest.approx((0.1, 0.0), abs=math.radians(0.3))


@pytest.mark.parametrize("color", [ORANGE, BROWN, PINK, (200, 60, 40)], ids=["orange", "brown", "pink", "blue"])
def test_balls_of_other_colours_are_none(detector, color):
    assert detector.detect(sphere(0.6, 0.05, color=color), OPTICS) == []


def rectangle(width, height, turn=0.0):
    def draw(picture, color):
        box = cv2.boxPoints(((640.0, 480.0), (4.0 * width, 4.0 * height), turn))
        cv2.fillPoly(picture, [np.int32(box)], color)

    return draw


def ellipse(width, height):
    return lambda picture, color: cv2.ellipse(picture, (640, 480), (2 * width, 2 * height), 20, 0, 360, color, -1)


@pytest.mark.parametrize("size", [9, 14, 30, 80])
@pytest.mark.parametrize("turn", [0.0, 20.0, 45.0])
def test_squares_are_no_balls(detector, size, turn):
    assert detector.detect(shape(rectangle(size, size, turn)), OPTICS) == []


@pytest.mark.parametrize("width, height", [(60, 20), (20, 70), (14, 10), (300, 200)])
def test_boards_are_no_balls(detector, width, height):
    assert detector.detect(shape(rectangle(width, height, 10.0)), OPTICS) == []


@pytest.mark.parametrize("width, height", [(40, 30), (16, 12), (80, 60)])
def test_cushions_are_no_balls(detector, width, height):
    assert detector.detect(shape(ellipse(width, height)), OPTICS) == []
    assert len(detector.detect(shape(ellipse(width, width)), OPTICS)) == 1  # it is the outline that tells


def test_a_round_thing_in_the_orange_of_the_robot_is_no_ball(detector):
    """Its own forearm, as the lower camera sees it."""
    orange = (16, 88, 200)
    assert (
        detector.detect(shape(lambda picture, color: cv2.circle(picture, (640, 480), 160, color, -1), orange), OPTICS)
        == []
    )


def test_red_all_over_is_no_ball(detector):
    assert detector.detect(np.full((240, 320, 3), RED, np.uint8), OPTICS) == []
    noise = np.random.default_rng(1).integers(0, 256, (240, 320, 3)).astype(np.uint8)
    assert detector.detect(noise, OPTICS) == []
