"""Places on the floor."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.places import ORIGIN, Place, wrapped, yaw_of_quaternion

QUARTER = math.pi / 2


def test_a_way_is_told_in_the_frame_of_where_it_begins():
    assert Place(1.0, 2.0, QUARTER).then(Place(0.5, 0.0, 0.1)) == pytest.approx((1.0, 2.5, QUARTER + 0.1))


@pytest.mark.parametrize("here", [Place(0.3, -0.2, 2.5), Place(-1.0, 4.0, -3.0)])
@pytest.mark.parametrize("there", [Place(1.0, 0.5, -2.9), ORIGIN])
def test_the_way_from_here_to_there_leads_there(here, there):
    assert here.then(there.seen_from(here)) == pytest.approx(there)


def test_there_and_back_is_the_origin():
    place = Place(0.7, -0.1, 1.2)
    assert place.then(place.inverse()) == pytest.approx(ORIGIN)


@pytest.mark.parametrize(
    "angle, same",
    [(0.0, 0.0), (math.pi, math.pi), (-math.pi, math.pi), (4.0, 4.0 - 2 * math.pi), (-7.0, -7.0 + 2 * math.pi)],
)
def test_angles_are_wrapped_to_half_a_turn(angle, same):
    assert wrapped(angle) == pytest.approx(same)


def test_headings_of_quaternions():
    assert yaw_of_quaternion(0.0, 0.0, math.sin(0.4), math.cos(0.4)) == pytest.approx(0.8)
    assert yaw_of_quaternion(0.0, 0.0, 2 * math.sin(0.4), 2 * math.cos(0.4)) == pytest.approx(0.8)  # not of length 1
    tilt = math.sin(0.1), math.cos(0.1)
    assert yaw_of_quaternion(0.0, tilt[0], 0.0, tilt[1]) == pytest.approx(0.0)
    assert yaw_of_quaternion(0.0, 0.0, 0.0, 0.0) is None
    assert yaw_of_quaternion(0.0, 0.0, math.nan, 1.0) is None
