"""Checks of arguments: texts name the argument, what it was, and what is allowed."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.services.arguments import number, numbers, per_item
from nao_sim_bridge.sim.errors import BadValue


@pytest.mark.parametrize("value", [0, 0.5, 1])
def test_a_number_within_the_range_is_a_float(value):
    assert number(value, "speed", 0.0, 1.0) == value
    assert isinstance(number(value, "speed", 0.0, 1.0), float)


@pytest.mark.parametrize("value", [True, "0.5", None, [0.5], math.nan, math.inf])
def test_what_is_no_finite_number_is_refused(value):
    with pytest.raises(BadValue, match="speed is .*, allowed is a finite number"):
        number(value, "speed")


@pytest.mark.parametrize(
    "value, low, high, allowed",
    [(1.5, 0.0, 1.0, "0 to 1"), (-0.1, 0.0, 1.0, "0 to 1"), (-1, 0.0, math.inf, "0 or more")],
)
def test_a_number_out_of_range_names_the_range(value, low, high, allowed):
    with pytest.raises(BadValue, match=f"speed is {value}, allowed is {allowed}"):
        number(value, "speed", low, high)


def test_a_wrong_number_in_a_list_is_named_by_its_place():
    assert numbers([1, 2.5], "force") == [1.0, 2.5]
    with pytest.raises(BadValue, match=r"force\[1\] is 'x'"):
        numbers([1.0, "x"], "force")
    with pytest.raises(BadValue, match="force is 3, allowed is a list of numbers"):
        numbers(3, "force")


@pytest.mark.parametrize("value, expected", [(0.5, [0.5] * 3), ([0.5], [0.5] * 3), ([1, 2, 3], [1.0, 2.0, 3.0])])
def test_one_number_serves_all_items(value, expected):
    assert per_item(value, 3, "angles") == expected


@pytest.mark.parametrize("value", [[], [1, 2], [1, 2, 3, 4]])
def test_a_list_of_another_length_is_refused_with_the_right_one(value):
    with pytest.raises(BadValue, match="angles is .*, allowed is one number or 3, one for each joint"):
        per_item(value, 3, "angles")
