"""Paths: lengths, places, straightness."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.path_follower_path import WalkPath
from nao_library_modules.errors import BadGoal
from nao_library_modules.places import Place

QUARTER = math.pi / 2
CORNER = [Place(0.0, 0.0, 3.0), Place(1.0, 0.0, 3.0), Place(1.0, 0.5, 0.25)]


@pytest.fixture
def corner():
    return WalkPath(CORNER)


def test_length_and_places(corner):
    assert corner.length == pytest.approx(1.5)
    assert corner.place_at(0.25) == pytest.approx((0.25, 0.0, 0.0))
    assert corner.place_at(1.2) == pytest.approx((1.0, 0.2, QUARTER))
    assert corner.place_at(-1.0) == pytest.approx((0.0, 0.0, 0.0))


def test_the_last_heading_counts_the_others_follow_the_path(corner):
    assert corner.place_at(1.5) == CORNER[-1]
    assert corner.place_at(1.49).yaw == pytest.approx(QUARTER)
    assert (corner.direction_at(1.0), corner.direction_at(9.0)) == pytest.approx((QUARTER, QUARTER))


def test_waypoints_ahead_are_counted_as_they_were_given():
    path = WalkPath([CORNER[0], CORNER[0], CORNER[1], CORNER[1], CORNER[2]])
    assert [path.index_at(along) for along in (0.0, 0.9, 1.1, 1.5)] == [3, 3, 4, 4]
    assert path.length == pytest.approx(1.5)


@pytest.mark.parametrize(
    "waypoints, words", [([], "0 pose"), (CORNER[:1], "1 pose"), ([CORNER[0]] * 3, "3 poses at one")]
)
def test_a_path_of_a_single_place_is_none(waypoints, words):
    with pytest.raises(BadGoal, match=words):
        WalkPath(waypoints)


def test_the_nearest_place_is_looked_for_within_a_window(corner):
    found = corner.nearest(Place(0.5, 0.1, 0.0), 0.0, 1.5)
    assert (found.along, found.off) == pytest.approx((0.5, 0.1))
    late = corner.nearest(Place(0.5, 0.1, 0.0), 0.8, 1.5)
    assert late.along == pytest.approx(0.8)
    beyond = corner.nearest(Place(1.2, 0.9, 0.0), 0.0, 5.0)
    assert (beyond.along, beyond.off) == pytest.approx((1.5, math.hypot(0.2, 0.4)))
    inside = corner.nearest(Place(0.95, 0.2, 0.0), 0.0, 1.5)
    assert inside.along == pytest.approx(1.2)


def test_straight_is_what_keeps_near_a_line(corner):
    assert corner.straight(0.1, 0.9, 0.01)
    assert corner.straight(1.1, 9.0, 0.01)
    assert not corner.straight(0.8, 1.2, 0.05)
    assert corner.straight(0.95, 1.0, 0.05)
    wavy = WalkPath([Place(0.1 * i, 0.02 * (i % 2), 0.0) for i in range(10)])
    assert wavy.straight(0.0, 0.6, 0.03)
    assert not wavy.straight(0.0, 0.6, 0.01)
    back = WalkPath([Place(0.0, 0.0, 0.0), Place(1.0, 0.0, 0.0), Place(0.5, 0.0, 0.0)])
    assert not back.straight(0.6, 1.3, 0.03)
