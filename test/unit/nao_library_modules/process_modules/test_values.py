"""What may stand for a point, a position and a place in designators."""

from __future__ import annotations

import pytest

from nao_library_modules.places import Place
from nao_library_modules.process_modules.action_rules.values import a_place, a_point, a_position
from nao_library_modules.process_modules.designators.patterns import Mismatch
from nao_library_modules.process_modules.space import Point3


def test_points_are_in_the_torso_frame_unless_they_name_another():
    assert a_point().take([1, 2, 3]) == Point3(1.0, 2.0, 3.0, "torso")
    assert a_point().take([1, 2, 3, "odom"]) == Point3(1.0, 2.0, 3.0, "odom")
    assert a_point().take({"x": 1, "frame": "odom"}) == Point3(1.0, 0.0, 0.0, "odom")


def test_two_numbers_are_a_position_at_the_height_of_the_eyes():
    assert a_position().take([2, 3]) == Point3(2.0, 3.0, 0.19, "torso")


def test_places_are_in_odom_unless_they_name_another_frame():
    assert a_place().take([1, 2]) == (Place(1.0, 2.0, 0.0), "odom")
    assert a_place().take([1, 2, 0.5, "map"]) == (Place(1.0, 2.0, 0.5), "map")
    assert a_place().take({"x": 1, "y": 2}) == (Place(1.0, 2.0, 0.0), "odom")
    assert a_place().take((Place(1.0, 2.0, 0.0), "map")) == (Place(1.0, 2.0, 0.0), "map")


@pytest.mark.parametrize("value", ["near", [1, 2], [1, 2, float("nan")], [1, None, 3], [1, 2, 3, "odom", 5], 7])
def test_what_is_no_point_is_refused(value):
    with pytest.raises(Mismatch):
        a_point().take(value)


@pytest.mark.parametrize("value", [["a", "b"], [1, float("inf")], [1], "door", [1, 2, "c"]])
def test_what_is_no_position_is_refused(value):
    with pytest.raises(Mismatch):
        a_position().take(value)


@pytest.mark.parametrize(
    "value", [["a", 2], [1, float("nan")], [1, 2, 3, 4], {"x": "a", "y": 2}, [1, "odom"], {"x": 1}, "door"]
)
def test_what_is_no_place_is_refused(value):
    with pytest.raises(Mismatch):
        a_place().take(value)
