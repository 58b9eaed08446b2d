"""Velocities along a way, and robots that get no nearer."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.path_follower_settings import Settings
from nao_library_modules.driver.path_follower_steering import StuckWatch, velocity
from nao_library_modules.places import Place
from naoqi.errors import NaoError

SETTINGS = Settings(max_vel_x=0.8, max_vel_y=0.4, max_vel_yaw=0.5)


def test_straight_ahead_is_walked_at_full_speed_and_slower_near_the_end():
    assert velocity(Place(2.0, 0.0, 0.0), SETTINGS) == pytest.approx((0.8, 0.0, 0.0))
    assert velocity(Place(0.1, 0.0, 0.0), SETTINGS) == pytest.approx((0.4, 0.0, 0.0))


def test_the_direction_is_kept_where_one_way_is_slower():
    x, y, _ = velocity(Place(0.2, 0.1, 0.0), SETTINGS)
    assert y / x == pytest.approx(0.5)
    assert math.hypot(x / 0.8, y / 0.4) == pytest.approx(1.0)


def test_near_by_it_turns_to_the_heading_of_the_target_and_walks_sideways():
    x, y, yaw = velocity(Place(0.0, -0.2, 0.1), SETTINGS)
    assert (x, y) == pytest.approx((0.0, -0.4))
    assert yaw == pytest.approx(0.5 * 0.1 / SETTINGS.threshold_damp_yaw)


def test_far_away_it_turns_its_face_first():
    x, y, yaw = velocity(Place(-1.0, 0.1, 0.0), SETTINGS)
    assert (x, y, yaw) == (0.0, 0.0, 0.5)
    assert velocity(Place(0.0, -1.0, 0.0), SETTINGS)[2] == -0.5


def test_on_the_spot_it_only_turns():
    assert velocity(Place(0.0, 0.0, -2.0), SETTINGS) == (0.0, 0.0, -0.5)


def test_no_command_is_faster_than_allowed():
    for i in range(24):
        for distance in (0.05, 0.3, 3.0):
            angle = i * math.pi / 12
            way = Place(distance * math.cos(angle), distance * math.sin(angle), angle)
            x, y, yaw = velocity(way, SETTINGS)
            assert abs(x) <= 0.8 + 1e-9 and abs(y) <= 0.4 + 1e-9 and abs(yaw) <= 0.5


def test_a_robot_that_gets_nearer_is_not_stuck():
    watch = StuckWatch(5.0)
    for second in range(60):
        watch.check(second, 3.0 - 0.01 * second)


def test_one_that_does_not_is_told_how_far_it_got():
    watch = StuckWatch(5.0)
    watch.check(0.0, 1.0)
    watch.check(3.0, 0.7)
    watch.check(8.0, 0.69)
    with pytest.raises(NaoError, match=r"no progress for 5 s, with 0\.69 m still to go"):
        watch.check(8.1, 0.69)


def test_nobody_minds_without_a_limit():
    watch = StuckWatch(0.0)
    watch.check(0.0, 1.0)
    watch.check(1e6, 1.0)
