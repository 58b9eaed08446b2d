"""Transforms that odometry is set to."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Transform

from nao_library_modules.driver.odometry_services import read_transform
from nao_library_modules.driver.rotation import from_roll_pitch_yaw
from nao_library_modules.errors import BadGoal


def transform(x, y, z, *turn):
    message = Transform()
    message.translation.x, message.translation.y, message.translation.z = x, y, z
    message.rotation.x, message.rotation.y, message.rotation.z, message.rotation.w = turn
    return message


def test_what_lies_in_the_plane_of_the_floor_counts():
    turn = from_roll_pitch_yaw(0.1, 0.0, 0.8)
    assert read_transform(transform(1.0, 2.0, 9.0, *turn)) == pytest.approx((1.0, 2.0, 0.8))


@pytest.mark.parametrize(
    "message, words",
    [
        (transform(0, 0, 0, 0, 0, 0, 0), r"offset\.rotation"),
        (transform(math.nan, 0, 0, 0, 0, 0, 1), r"offset\.translation\.x"),
        (transform(0, math.inf, 0, 0, 0, 0, 1), r"offset\.translation\.y"),
    ],
)
def test_what_is_no_transform_is_told(message, words):
    with pytest.raises(BadGoal, match=words):
        read_transform(message)
