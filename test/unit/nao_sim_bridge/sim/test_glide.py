"""Ways between two poses, and the arithmetic of turns that they need."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.glide import Glide, slerp
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw, multiply, roll_pitch_yaw, rotate

UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def test_a_way_is_straight_and_ends_at_its_target():
    glide = Glide(Pose((1.0, 0.0, 0.2), UPRIGHT), Pose((1.0, 2.0, 0.2), from_roll_pitch_yaw(0, 0, 1.0)), 10.0, 4.0)
    assert glide.velocity == pytest.approx((0.0, 0.5, 0.0))
    assert glide.at(9.0) == glide.start
    halfway = glide.at(12.0)
    assert halfway.position == pytest.approx((1.0, 1.0, 0.2))
    assert roll_pitch_yaw(halfway.orientation) == pytest.approx((0.0, 0.0, 0.5))
    assert not glide.ended(13.99) and glide.ended(14.0)
    assert glide.at(14.0) is glide.target and glide.at(99.0) is glide.target


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_turns_go_the_short_way_round(sign):
    end = tuple(sign * part for part in from_roll_pitch_yaw(0.0, 0.0, -3.0))
    yaw = roll_pitch_yaw(slerp(from_roll_pitch_yaw(0.0, 0.0, 3.0), end, 0.5))[2]
    assert abs(yaw) == pytest.approx(math.pi, abs=1e-6)


def test_a_turn_by_nothing_stays():
    turn = from_roll_pitch_yaw(0.1, 0.2, 0.3)
    assert slerp(turn, turn, 0.5) == pytest.approx(turn)


def test_a_product_of_turns_turns_by_the_second_first():
    first, second = from_roll_pitch_yaw(0.3, -0.5, 1.1), from_roll_pitch_yaw(-0.2, 0.9, 0.4)
    point = (0.3, -0.7, 1.2)
    assert rotate(multiply(first, second), point) == pytest.approx(rotate(first, rotate(second, point)))
