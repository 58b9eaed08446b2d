"""Parameters of the path follower."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.driver.path_follower_settings import Settings
from naoqi.errors import NaoError


def test_names_of_parameters_are_those_of_the_settings():
    given = {"~target_distance_threshold": 0.02, "~use_vel_ctrl": True, "~controller_frequency": 20}
    settings = Settings.read(lambda name, default: given.get(name, default))
    assert (settings.target_distance_threshold, settings.use_vel_ctrl, settings.controller_frequency) == (
        0.02,
        True,
        20,
    )
    assert settings.path_next_target_distance == Settings().path_next_target_distance


@pytest.mark.parametrize(
    "name, value",
    [
        ("controller_frequency", 0),
        ("target_angle_threshold", -1.0),
        ("max_vel_x", 1.5),
        ("step_freq", 2.0),
        ("stuck_time", -1.0),
        ("use_vel_ctrl", 1),
        ("threshold_damp_xy", "far"),
        ("straight_offset", math.nan),
        ("max_vel_y", True),
    ],
)
def test_what_will_not_do_is_named(name, value):
    with pytest.raises(NaoError, match=f"~{name} is"):
        Settings(**{name: value})
