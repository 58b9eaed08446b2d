"""Quaternions."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.rotation import about, from_roll_pitch_yaw, inverse, product, rotate, yaw_of

QUARTER = math.pi / 2


@pytest.mark.parametrize(
    "angles, vector, turned",
    [
        ((QUARTER, 0, 0), (0, 1, 0), (0, 0, 1)),
        ((0, QUARTER, 0), (0, 0, 1), (1, 0, 0)),
        ((0, 0, QUARTER), (1, 0, 0), (0, 1, 0)),
        ((QUARTER, 0, QUARTER), (0, 1, 0), (0, 0, 1)),  # roll first, then yaw
    ],
)
def test_turns_follow_the_right_hand(angles, vector, turned):
    assert rotate(from_roll_pitch_yaw(*angles), vector) == pytest.approx(turned, abs=1e-12)


def test_an_inverse_turns_back():
    turn = from_roll_pitch_yaw(0.1, -0.7, 2.0)
    assert product(turn, inverse(turn)) == pytest.approx((0, 0, 0, 1))


def test_products_turn_one_after_the_other():
    a, b, v = about((0.0, 0.0, 1.0), 0.4), about((1.0, 0.0, 0.0), -1.1), (0.3, -0.2, 0.9)
    assert rotate(product(a, b), v) == pytest.approx(rotate(a, rotate(b, v)))


def test_heading():
    assert yaw_of((0.0, 2.0, 5.0)) == pytest.approx(QUARTER)
