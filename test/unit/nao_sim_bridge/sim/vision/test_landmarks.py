"""Landmarks in drawn pictures: their numbers, where they are, how they are turned, and what is none."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from seen_cards import OPTICS, card, mark

from nao_sim_bridge.sim.landmarks import load_landmarks
from nao_sim_bridge.sim.vision.landmarks import LandmarkDetector
from nao_sim_bridge.sim.world_pictures import WorldPicture

NUMBERS = sorted(load_landmarks().marks)
SIZE = load_landmarks().diameter


@pytest.fixture(scope="module")
def detector():
    return LandmarkDetector()


@pytest.mark.parametrize("number", NUMBERS)
def test_every_number_is_read_from_far_and_slanted(detector, number):
    roll = 0.35 * (number % 17) - 3.0
    (seen,) = detector.detect(mark(number, 1.5, alpha=0.1, beta=-0.05, yaw=0.7, roll=roll, seed=number), OPTICS)
    assert seen.number == number


@pytest.mark.parametrize("distance", [0.4, 0.8, 1.5])
@pytest.mark.parametrize("alpha, beta", [(0.0, 0.0), (0.25, -0.2), (-0.3, 0.15)])
def test_a_mark_is_where_it_is_and_as_large(detector, distance, alpha, beta):
    (seen,) = detector.detect(mark(119, distance, alpha=alpha, beta=beta), OPTICS)
    assert seen.alpha == pytest.approx(alpha, abs=math.radians(0.2))
    assert seen.beta == pytest.approx(beta, abs=math.radians(0.2))
    angle = 2.0 * math.atan(SIZE / 2.0 / distance)
    assert seen.size == pytest.approx(angle, rel=0.03)
    assert seen.height == pytest.approx(angle, rel=0.12)
    assert (seen.x, seen.y) == pytest.approx(OPTICS.place(alpha, beta), abs=0.005)


@pytest.mark.parametrize("roll", [-2.5, -0.6, 0.0, 0.2, 1.0, 3.0])
def test_its_heading_is_its_turn_in_the_picture(detector, roll):
    (seen,) = detector.detect(mark(84, 0.8, roll=roll), OPTICS)
    assert math.remainder(seen.heading - roll, 2.0 * math.pi) == pytest.approx(0.0, abs=math.radians(2.0))


def test_a_mark_turned_away_is_narrower_and_no_smaller(detector):
    (seen,) = detector.detect(mark(84, 0.8, yaw=math.radians(40.0)), OPTICS)
    angle = 2.0 * math.atan(SIZE / 2.0 / 0.8)
    assert seen.width == pytest.approx(angle * math.cos(math.radians(40.0)), rel=0.06)
    assert seen.height == pytest.approx(angle, rel=0.05)
    assert seen.size == pytest.approx(angle, rel=0.05)


def test_several_at_once_come_from_left_to_right(detector):
    picture = mark(187, 0.9, alpha=-0.3)
    for number, alpha in ((64, 0.3), (170, 0.05)):
        picture = mark(number, 0.9, alpha=alpha, onto=picture)
    assert [seen.number for seen in detector.detect(picture, OPTICS)] == [64, 170, 187]


@pytest.mark.parametrize("back", [10, 250], ids=["black", "white"])
def test_a_dark_and_a_white_wall_make_no_difference(detector, back):
    behind = np.full((240, 320, 3), back, np.uint8)
    assert [seen.number for seen in detector.detect(mark(136, 1.2, onto=behind), OPTICS)] == [136]


def test_light_that_is_not_even_makes_no_difference(detector):
    shade = np.linspace(0.25, 1.0, 320)[None, :, None]
    picture = mark(136, 0.8, alpha=0.2)
    for number, alpha in ((145, -0.2),):
        picture = mark(number, 0.8, alpha=alpha, onto=picture)
    found = detector.detect((picture * shade).astype(np.uint8), OPTICS)
    assert [seen.number for seen in found] == [136, 145]


def test_a_mark_that_the_edge_cuts_is_not_read(detector):
    assert detector.detect(mark(119, 0.6, alpha=OPTICS.hfov / 2.0 - 0.02), OPTICS) == []


def wheel(spokes):
    """A black disc with evenly spaced white fans on a white card: no mark."""
    picture = np.full((240, 320, 3), 120, np.uint8)
    cv2.rectangle(picture, (110, 70), (210, 170), (230, 230, 230), -1)
    cv2.circle(picture, (160, 120), 40, (25, 25, 25), -1, cv2.LINE_AA)
    for spoke in range(spokes):
        begin = 360.0 * spoke / spokes
        cv2.ellipse(picture, (160, 120), (32, 32), 0, begin, begin + 180.0 / spokes, (230, 230, 230), -1, cv2.LINE_AA)
    return picture


@pytest.mark.parametrize("spokes", [0, 1, 2, 3, 4, 5, 6, 7, 8, 9])
def test_other_wheels_are_no_marks(detector, spokes):
    assert detector.detect(wheel(spokes), OPTICS) == []


def test_a_mark_with_two_wrong_sectors_is_no_mark(detector):
    table = load_landmarks()
    picture = mark(119, 0.5)
    center, radius = (160.0, 120.0), OPTICS.intrinsics(320, 240).fx * SIZE / 2.0 / 0.5
    for sector in (2, 9):
        begin = 360.0 * sector / table.sectors - 90.0
        color = (25, 25, 25) if table.marks[119][sector] else (229, 229, 229)
        turns = np.radians(np.linspace(begin, begin + 360.0 / table.sectors, 8))
        arc = np.stack([np.cos(turns), np.sin(turns)], axis=1) * radius
        outline = np.concatenate([arc * table.fan_outer, arc[::-1] * table.fan_inner]) + center
        cv2.fillPoly(picture, [np.int32(outline * 16)], color, cv2.LINE_AA, 4)
    assert detector.detect(picture, OPTICS) == []


@pytest.mark.parametrize("kind, content", [("qr", "119"), ("barcode", "4006381333931")])
def test_codes_are_no_marks(detector, kind, content):
    assert detector.detect(card(WorldPicture(kind, content), 0.15, 0.6), OPTICS) == []


def test_noise_is_no_mark(detector):
    noise = np.random.default_rng(3).integers(0, 256, (240, 320, 3)).astype(np.uint8)
    soft = cv2.GaussianBlur(noise, (0, 0), 5.0)
    assert detector.detect(noise, OPTICS) == []
    assert detector.detect(cv2.normalize(soft, None, 0, 255, cv2.NORM_MINMAX), OPTICS) == []
