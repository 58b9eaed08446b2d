"""Poses of feet on the ground."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.walk.footsteps import FootPose, middle


def test_a_move_is_in_the_own_frame():
    assert FootPose(1.0, 2.0, math.pi / 2).moved(0.5, 0.1, 0.2) == pytest.approx((0.9, 2.5, math.pi / 2 + 0.2))


def test_what_was_moved_is_seen_where_it_was_moved_to():
    start = FootPose(0.3, -0.2, 2.5)
    assert start.moved(0.4, -0.1, 1.5).seen_from(start) == pytest.approx((0.4, -0.1, 1.5))


def test_turns_are_seen_the_short_way():
    assert FootPose(0.0, 0.0, 3.0).seen_from(FootPose(0.0, 0.0, -3.0)).yaw == pytest.approx(6.0 - 2 * math.pi)


def test_the_middle_of_two_feet_across_180_degrees():
    x, y, yaw = middle(FootPose(0.0, 0.05, 3.1), FootPose(0.1, -0.05, -3.1))
    assert (x, y) == pytest.approx((0.05, 0.0))
    assert math.cos(yaw) == pytest.approx(-1.0, abs=1e-3)
