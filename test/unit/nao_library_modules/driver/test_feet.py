"""Soles and footprint, against the published lengths."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.feet import LEG_JOINTS, footprint, sole
from nao_library_modules.driver.rotation import from_roll_pitch_yaw, product, rotate, yaw_of

STRAIGHT = dict.fromkeys((joint for joints in LEG_JOINTS.values() for joint in joints), 0.0)


def legs(**angles):
    return {**STRAIGHT, **{side + name: value for side in "LR" for name, value in angles.items()}}


@pytest.mark.parametrize("side, y", [("L", 0.05), ("R", -0.05)])
def test_soles_of_straight_legs_are_where_the_tables_say(side, y):
    place, toes = sole(side, [0.0] * 6)
    assert place == pytest.approx((0.0, y, -0.33309))
    assert toes == pytest.approx((1.0, 0.0, 0.0))


def test_bent_legs_shorten_by_thigh_and_tibia():
    bend = 0.4
    for side in "LR":
        place, _ = sole(side, [0.0, 0.0, -bend, 2 * bend, -bend, 0.0])
        assert place[0] == pytest.approx((0.1 - 0.1029) * math.sin(bend))
        assert place[2] == pytest.approx(-0.085 - (0.1 + 0.1029) * math.cos(bend) - 0.04519)


def test_the_hip_turns_both_feet_outwards_or_inwards():
    _, left = sole("L", [-0.3, 0, 0, 0, 0, 0])
    _, right = sole("R", [-0.3, 0, 0, 0, 0, 0])
    assert yaw_of(left) == pytest.approx(-yaw_of(right))
    assert abs(yaw_of(left)) > 0.2


def test_the_footprint_is_level_whatever_the_torso_does():
    roll, pitch = 0.1, -0.2
    place, turn = footprint(STRAIGHT, roll, pitch)
    tilt = from_roll_pitch_yaw(roll, pitch, 0.0)
    up = rotate(product(tilt, turn), (0.0, 0.0, 1.0))
    assert up == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)
    assert rotate(tilt, place)[2] < -0.3


def test_the_footprint_lies_under_the_lower_foot():
    place, _ = footprint({**STRAIGHT, **dict(zip(LEG_JOINTS["L"], (0, 0, -0.5, 1.0, -0.5, 0)))}, 0.0, 0.0)
    assert place[2] == pytest.approx(-0.33309)


def test_a_robot_without_legs_has_no_footprint():
    with pytest.raises(KeyError):
        footprint({"HeadYaw": 0.0}, 0.0, 0.0)
