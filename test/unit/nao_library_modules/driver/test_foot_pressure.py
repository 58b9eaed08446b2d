"""Forces under the feet, from kg to N."""

from __future__ import annotations

import math

import fake_memory
import fake_sound
import pytest

from nao_library_modules.driver.foot_pressure import keys_of, read_feet, read_foot


def test_both_feet_come_in_one_question(make_call):
    memory = fake_memory.Memory(dict(zip(keys_of("left"), [0.5, 0.6, 0.7, 0.8, 2.6, 0.01, 0.002, 1.0])))
    feet = read_feet(fake_sound.Robot(make_call, ALMemory=memory))
    left, right = feet["left"], feet["right"]
    assert left.forces == pytest.approx((4.905, 5.886, 6.867, 7.848))
    assert (left.total, left.center, left.contact) == (pytest.approx(25.506), (0.01, 0.002), True)
    assert math.isnan(right.total) and not right.contact and len(memory.asked) == 1


def test_a_foot_in_the_air_has_no_centre_of_pressure():
    foot = read_foot([0.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0])
    assert all(math.isnan(each) for each in foot.center) and foot.total == pytest.approx(0.0981)


def test_keys_have_the_names_of_the_robot():
    assert keys_of("right")[3] == "Device/SubDeviceList/RFoot/FSR/RearRight/Sensor/Value"
    assert keys_of("right")[-1] == "rightFootContact"
