"""Balls, landmarks, codes and movement in drawn pictures: where they are, how far, and what is none."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from seen_cards import GREY, OPTICS, card, mark, sphere

from nao_sim_bridge.vision.ball import BallDetector
from nao_sim_bridge.vision.barcodes import BarcodeDetector
from nao_sim_bridge.vision.landmarks import LandmarkDetector
from nao_sim_bridge.vision.movement import MovementDetector, MovementSettings
from nao_sim_bridge.world.painting.known_landmarks import load_landmarks
from nao_sim_bridge.world.pictures import WorldPicture

NUMBERS, SIZE = sorted(load_landmarks().marks), load_landmarks().diameter
NOISE = np.random.default_rng(3).integers(0, 256, (240, 320, 3)).astype(np.uint8)
SOFT = cv2.normalize(cv2.GaussianBlur(NOISE, (0, 0), 5.0), None, 0, 255, cv2.NORM_MINMAX)


def of(detector):
    """What a detector finds in a picture."""
    made = detector()
    return lambda picture: made.detect(picture, OPTICS)


balls, marks, codes = of(BallDetector), of(LandmarkDetector), of(BarcodeDetector)


@pytest.mark.parametrize("find", [balls, marks, codes], ids=["balls", "marks", "codes"])
def test_noise_is_nothing(find):
    assert find(NOISE) == [] and find(SOFT) == []


@pytest.mark.parametrize("radius, distance", [(0.03, 0.3), (0.03, 2.0), (0.05, 1.0)])
@pytest.mark.parametrize("alpha, beta", [(0.0, 0.0), (0.3, 0.2), (-0.25, -0.15)])
def test_a_ball_is_found_where_it_is(radius, distance, alpha, beta):
    (ball,) = balls(sphere(distance, radius, alpha, beta))
    assert (ball.alpha, ball.beta) == pytest.approx((alpha, beta), abs=math.radians(0.2))
    assert ball.radius == pytest.approx(math.asin(radius / distance), rel=0.05)
    assert ball.distance(radius) == pytest.approx(distance, rel=0.05)
    assert (ball.x, ball.y) == pytest.approx(OPTICS.place(alpha, beta), abs=0.005)


ACROSS, DOWN = (field / 2.0 for field in OPTICS.fov)


@pytest.mark.parametrize(
    "alpha, beta",
    [(ACROSS - 0.01, 0.1), (0.01 - ACROSS, -0.1), (0.1, DOWN - 0.01), (ACROSS - 0.03, DOWN - 0.03)],
)
def test_a_ball_that_the_edge_of_the_picture_cuts_is_found_where_it_is(alpha, beta):
    (ball,) = balls(sphere(0.6, 0.05, alpha, beta))
    assert (ball.alpha, ball.beta) == pytest.approx((alpha, beta), abs=math.radians(0.5))
    assert ball.distance(0.05) == pytest.approx(0.6, rel=0.05)


def drawn(draw, color=(20, 25, 215)):
    """A picture with what `draw(picture, color)` draws, with smooth edges."""
    fine = np.empty((960, 1280, 3), np.uint8)
    fine[:] = GREY
    draw(fine, color)
    return cv2.resize(fine, (320, 240), interpolation=cv2.INTER_AREA)


def rectangle(width, height, turn=0.0):
    box = np.int32(cv2.boxPoints(((640.0, 480.0), (4.0 * width, 4.0 * height), turn)))
    return drawn(lambda picture, color: cv2.fillPoly(picture, [box], color))


def ellipse(width, height, *color):
    size = (2 * width, 2 * height)
    return drawn(lambda picture, color: cv2.ellipse(picture, (640, 480), size, 20, 0, 360, color, -1), *color)


def test_what_is_not_round_and_red_is_no_ball():
    """Its own orange forearm among it, as the lower camera sees it."""
    for color in ((20, 130, 235), (55, 85, 140), (150, 90, 230), (200, 60, 40)):
        assert balls(sphere(0.6, 0.05, color=color)) == [], color
    for size in (9, 14, 30, 80):
        assert [balls(rectangle(size, size, turn)) for turn in (0.0, 20.0, 45.0)] == [[]] * 3, size
    for width, height in ((60, 20), (20, 70), (14, 10), (300, 200)):
        assert balls(rectangle(width, height, 10.0)) == [], (width, height)
    for width, height in ((40, 30), (16, 12), (80, 60)):
        assert balls(ellipse(width, height)) == [] and len(balls(ellipse(width, width))) == 1
    assert balls(ellipse(80, 80, (16, 88, 200))) == []
    assert balls(np.full((240, 320, 3), (20, 25, 215), np.uint8)) == []


@pytest.mark.parametrize("number", NUMBERS)
def test_every_number_is_read_from_far_and_slanted(number):
    roll = 0.35 * (number % 17) - 3.0
    (seen,) = marks(mark(number, 1.5, alpha=0.1, beta=-0.05, yaw=0.7, roll=roll, seed=number))
    assert seen.number == number


@pytest.mark.parametrize("distance, alpha, beta", [(0.4, 0.0, 0.0), (0.8, 0.25, -0.2), (1.5, -0.3, 0.15)])
def test_a_mark_is_where_it_is_and_as_large(distance, alpha, beta):
    (seen,) = marks(mark(119, distance, alpha=alpha, beta=beta))
    assert (seen.alpha, seen.beta) == pytest.approx((alpha, beta), abs=math.radians(0.2))
    angle = 2.0 * math.atan(SIZE / 2.0 / distance)
    assert seen.size == pytest.approx(angle, rel=0.03) and seen.height == pytest.approx(angle, rel=0.12)
    assert (seen.x, seen.y) == pytest.approx(OPTICS.place(alpha, beta), abs=0.005)


@pytest.mark.parametrize("roll", [-2.5, -0.6, 0.0, 0.2, 1.0, 3.0])
def test_its_heading_is_its_turn_in_the_picture(roll):
    (seen,) = marks(mark(84, 0.8, roll=roll))
    assert math.remainder(seen.heading - roll, 2.0 * math.pi) == pytest.approx(0.0, abs=math.radians(2.0))


def test_several_come_from_left_to_right_on_every_wall_and_in_uneven_light():
    picture = mark(187, 0.9, alpha=-0.3)
    for number, alpha in ((64, 0.3), (170, 0.05)):
        picture = mark(number, 0.9, alpha=alpha, onto=picture)
    shade = np.linspace(0.25, 1.0, 320)[None, :, None]
    for seen in (picture, (picture * shade).astype(np.uint8)):
        assert [found.number for found in marks(seen)] == [64, 170, 187]
    for wall in (10, 250):
        behind = np.full((240, 320, 3), wall, np.uint8)
        assert [found.number for found in marks(mark(136, 1.2, onto=behind))] == [136]


QR, VGA = WorldPicture("qr", "hello world"), (640, 480)


def centre(code):
    return np.mean(code.corners, axis=0)


@pytest.mark.parametrize("size, distance", [((320, 240), 0.6), (VGA, 1.4)])
def test_a_qr_code_is_read_and_found_where_it_is(size, distance):
    (code,) = codes(card(QR, 0.2, distance, alpha=0.1, beta=-0.05, size=size))
    assert (code.text, code.kind) == ("hello world", "QRCode")
    assert centre(code) == pytest.approx(np.array(OPTICS.place(0.1, -0.05)) * size, abs=3.0)


POSE = (0.05, 0.0, 0.5, 0.0, 0.1, 0.0)


@pytest.fixture
def room():
    random = np.random.default_rng(1)
    coarse = random.integers(30, 220, (15, 20, 3), dtype=np.uint8)
    background = cv2.resize(coarse, (320, 240), interpolation=cv2.INTER_NEAREST)

    def picture(ball=None, shift=0.0, gain=1.0, noise=4.0):
        shown = cv2.warpAffine(background, np.float32([[1, 0, shift], [0, 1, 0]]), (320, 240), borderMode=1)
        if ball is not None:
            cv2.circle(shown, tuple(round(8 * x) for x in ball), 8 * 12, (20, 20, 220), -1, cv2.LINE_AA, 3)
        return np.clip(gain * shown + random.normal(0.0, noise, shown.shape), 0, 255).astype(np.uint8)

    return picture


def watch(pictures, sensitivity=0.8, poses=None, period=0.1):
    """What the detector says to each picture."""
    detector = MovementDetector()
    poses = poses or [POSE] * len(pictures)
    return [
        detector.detect(picture, OPTICS, MovementSettings(sensitivity, period * number, 0, pose))
        for number, (picture, pose) in enumerate(zip(pictures, poses))
    ]


def test_noise_sway_exposure_and_a_light_that_goes_on_are_no_movement(room):
    found = watch([room(shift=0.4 * np.sin(k)) for k in range(20)], sensitivity=1.0)
    assert found == [None, None] + [[]] * 18
    assert watch([room(gain=0.75 + 0.25 * np.cos(k / 4)) for k in range(20)])[2:] == [[]] * 18
    lit = [cv2.convertScaleAbs(room(), alpha=0.2, beta=5) for _ in range(5)] + [room() for _ in range(5)]
    assert not any(watch(lit))


@pytest.mark.parametrize("pixels", [2, 6, 15])
def test_a_ball_that_rolls_by_is_found_where_it_is(room, pixels):
    for number, clusters in enumerate(watch([room(ball=(80 + pixels * k, 120)) for k in range(8)])[2:], 2):
        cluster = clusters[0]
        # Between where it is and where it was two pictures ago.
        middle = 80 + pixels * (number - 1)
        assert cluster.alpha == pytest.approx(OPTICS.angles(middle / 320, 0.5)[0], abs=0.04)
        assert cluster.beta == pytest.approx(0.0, abs=0.03)
        (left, top), (width, height) = OPTICS.place(*cluster.corner), OPTICS.image_size(*cluster.size)
        assert 0.0 < left < middle / 320 < left + width < 1.0 and top < 0.5 < top + height
        assert width * 320 <= 24 + 2 * pixels + 8 and height * 240 <= 32
        assert 0.0 < cluster.share_of_picture < 0.03 < cluster.share_of_rectangle <= 1.0


def test_the_lower_the_sensitivity_the_more_it_takes_and_slow_pictures_are_compared_with_the_one_before(room):
    def faint(step):
        picture = room(noise=2.0).astype(np.int16)
        picture[100:140, 100 + 8 * step : 150 + 8 * step] += 30
        return np.clip(picture, 0, 255).astype(np.uint8)

    pictures = [faint(step) for step in range(6)]
    assert all(watch(pictures, sensitivity=0.9)[2:]) and not any(watch(pictures, sensitivity=0.3))
    found = watch([room(ball=(80 + 10 * k, 120)) for k in range(4)], period=1.0)
    assert found[0] is None and all(found[1:])


def test_a_moving_head_is_no_movement_and_afterwards_it_goes_on(room):
    poses = [POSE] * 4 + [(*POSE[:5], 0.02 * k) for k in range(1, 6)] + [(*POSE[:5], 0.1)] * 5
    shifts = [0] * 4 + [6 * k for k in range(1, 6)] + [30] * 5
    found = watch([room(shift=shift) for shift in shifts], poses=poses)
    assert found[2:4] == [[], []] and found[4:9] == [None] * 5 and found[-2:] == [[], []]
