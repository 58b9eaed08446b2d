"""Torque from current."""

from __future__ import annotations

import json
import math

import pytest

from nao_library_modules.driver.motors import read_motors, torque_per_ampere
from nao_library_modules.joint_trajectory import H25_BODY


def test_every_joint_has_a_motor():
    for joint in H25_BODY:
        assert 0.2 < torque_per_ampere(joint) < 5.0, joint


def test_left_and_right_are_alike_and_strangers_have_none():
    assert torque_per_ampere("LKneePitch") == torque_per_ampere("RKneePitch")
    assert math.isnan(torque_per_ampere("Tail"))


def test_the_torque_constant_is_voltage_over_speed(tmp_path):
    motor = {"model": "M", "no_load_rpm": 60.0, "gear_ratios": {"Tail": 10.0}}
    table = {"_source": "test", "voltage_v": 2.0 * math.pi, "gear_efficiency": 0.5, "motors": [motor]}
    path = tmp_path / "motors.json"
    path.write_text(json.dumps(table))
    assert read_motors(path) == {"Tail": pytest.approx(5.0)}
    path.write_text(json.dumps({**table, "voltage": 1.0}))
    with pytest.raises(ValueError, match="the fields are"):
        read_motors(path)
