"""Where a robot that follows a path aims."""

from __future__ import annotations

import dataclasses
import math

import pytest

from nao_library_modules.driver.path_follower_courses import PathCourse, TargetCourse, reached
from nao_library_modules.driver.path_follower_path import WalkPath
from nao_library_modules.driver.path_follower_settings import Settings
from nao_library_modules.errors import BadGoal
from nao_library_modules.places import Place

QUARTER = math.pi / 2
SETTINGS = Settings()
CORNER = WalkPath([Place(0.0, 0.0, 0.0), Place(1.0, 0.0, 0.0), Place(1.0, 1.0, 0.25)])


@pytest.fixture
def course():
    return PathCourse(CORNER, SETTINGS)


def test_on_a_straight_piece_it_looks_further_ahead(course):
    assert course.aim(Place(0.0, 0.0, 0.0)).place == pytest.approx((0.3, 0.0, 0.0))
    assert course.aim(Place(0.3, 0.01, 0.1)).place == pytest.approx((0.6, 0.0, 0.0))


@pytest.mark.parametrize("robot", [Place(0.2, 0.2, 0.0), Place(0.2, 0.0, 0.5)])
def test_off_the_path_or_turned_away_it_looks_nearer(course, robot):
    assert course.aim(robot).place == pytest.approx((0.3, 0.0, 0.0))


def test_before_a_corner_it_looks_nearer_and_round_it(course):
    course.aim(Place(0.2, 0.0, 0.0))
    course.aim(Place(0.5, 0.0, 0.0))
    aim = course.aim(Place(0.8, 0.0, 0.0))
    assert aim.place == pytest.approx((0.9, 0.0, 0.0))
    assert (aim.index, aim.final) == (1, False)
    assert course.aim(Place(0.95, 0.0, 0.0)).place == pytest.approx((1.0, 0.05, QUARTER))
    assert course.aim(Place(1.0, 0.1, QUARTER)).index == 2


def test_turned_far_away_it_turns_on_the_spot_first(course):
    assert course.aim(Place(0.05, 0.02, 2.0)).place == pytest.approx((0.05, 0.0, 0.0))


def test_it_ends_at_the_last_waypoint_with_its_heading(course):
    for x in (0.2, 0.5):
        course.aim(Place(x, 0.0, 0.0))
    course.aim(Place(0.8, 0.0, 0.0))
    course.aim(Place(1.0, 0.3, QUARTER))
    course.aim(Place(1.0, 0.7, QUARTER))
    aim = course.aim(Place(1.0, 0.95, QUARTER))
    assert aim.final
    assert aim.place == CORNER.waypoints[-1]
    assert aim.rest == pytest.approx(0.05 + 0.05 * (QUARTER - 0.25))


def test_what_is_left_gets_less_on_the_way(course):
    rests = [course.aim(Place(0.1 * i, 0.0, 0.0)).rest for i in range(10)]
    assert all(after < before for before, after in zip(rests, rests[1:]))


def test_where_a_path_comes_back_it_does_not_jump():
    square = WalkPath([Place(0, 0, 0), Place(1, 0, 0), Place(1, 1, 0), Place(0, 1, 0), Place(0, 0, -QUARTER)])
    aim = PathCourse(square, SETTINGS).aim(Place(0.0, 0.02, 0.0))
    assert not aim.final
    assert aim.place.x == pytest.approx(0.3)
    assert aim.rest > 3.9


def test_a_path_that_begins_elsewhere_is_refused(course):
    with pytest.raises(BadGoal, match=r"too far from start of path, 0\.50 m: at most 0\.3 m"):
        course.aim(Place(-0.5, 0.0, 0.0))
    wide = PathCourse(CORNER, dataclasses.replace(SETTINGS, path_max_start_distance=1.0))
    assert wide.aim(Place(-0.5, 0.0, 0.0)).place.x == pytest.approx(0.1)


def test_a_target_is_aimed_at_wherever_it_drifts():
    targets = iter([Place(1.0, 0.0, 1.0), Place(1.1, 0.0, 1.0)])
    course = TargetCourse(lambda: next(targets))
    first, second = (course.aim(Place(0.0, 0.0, 0.0)) for _ in range(2))
    assert first.final
    assert first.rest == pytest.approx(1.05)
    assert second.place.x == 1.1


def test_reached_is_near_and_turned_well():
    assert reached(Place(0.03, 0.03, 0.08), SETTINGS)
    assert not reached(Place(0.06, 0.0, 0.0), SETTINGS)
    assert not reached(Place(0.0, 0.0, -0.1), SETTINGS)
