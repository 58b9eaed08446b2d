"""What the fields of a light function may hold."""

from __future__ import annotations

import pytest

from nao_library_modules import light_goals
from nao_library_modules.errors import BadGoal

TWO = ["LeftFaceLeds", "RightFaceLeds"]


def test_one_intensity_for_all_or_one_each():
    assert light_goals.intensities(TWO, [0.5]) == [0.5, 0.5]
    assert light_goals.intensities(TWO, [0, 1]) == [0.0, 1.0]


@pytest.mark.parametrize(
    "lights, i_values, text",
    [
        (TWO, [0.1, 0.2, 0.3], "3 values for 2 lights: allowed are 1 (for all) or 2 (1 each)"),
        (TWO, [], "0 values for 2 lights: allowed are 1 (for all) or 2 (1 each)"),
        (["Brain0"], [0.1, 0.2], "2 values for 1 light: allowed are 1"),
    ],
)
def test_a_wrong_number_of_intensities_says_how_many_are_allowed(lights, i_values, text):
    with pytest.raises(BadGoal) as caught:
        light_goals.intensities(lights, i_values)
    assert str(caught.value) == f"field i_values: {text}"


@pytest.mark.parametrize("value", [-0.1, 1.5, float("nan"), float("inf")])
def test_intensities_stay_within_0_and_1(value):
    with pytest.raises(BadGoal, match=r"field i_values: .* each within 0\.\.1"):
        light_goals.intensities(["Brain0"], [value])
    with pytest.raises(BadGoal, match=r"field i_values: .* each within 0\.\.1"):
        light_goals.colours(["FaceLeds"], [0, value, 0], "")


def test_one_colour_for_all_or_one_each():
    assert light_goals.colours(TWO, [0, 1, 0], "") == [(0, 1, 0), (0, 1, 0)]
    assert light_goals.colours(TWO, [1, 0, 0, 0, 0, 1], "") == [(1, 0, 0), (0, 0, 1)]
    assert light_goals.colours(TWO, [], "cyan") == [(0, 1, 1), (0, 1, 1)]


def test_a_wrong_number_of_colour_values_says_how_many_are_allowed():
    with pytest.raises(BadGoal, match=r"4 values for the colours of 2 lights: allowed are 3 \(for all\) or 6"):
        light_goals.colours(TWO, [0, 1, 0, 1], "")


def test_a_colour_is_given_once():
    with pytest.raises(BadGoal, match="field i_values: there is a colour in str_param already"):
        light_goals.colours(TWO, [0, 1, 0], "green")


def test_colour_steps_from_numbers_or_names():
    assert light_goals.colour_steps([0.5, 1.0], [1, 0, 0, 0, 1, 0], "") == [(1, 0, 0), (0, 1, 0)]
    assert light_goals.colour_steps([0.5, 1.0], [], "red, #00FF00") == [(1, 0, 0), (0, 1, 0)]


@pytest.mark.parametrize(
    "i_values, str_param, text",
    [
        ([1, 0, 0], "", r"field i_values: 3 values for 2 times: allowed are 6"),
        ([], "red", r"field str_param: 1 colour for 2 times: allowed are 2"),
        ([], "red, grene", r"field str_param: unknown colour ' grene'"),
    ],
)
def test_wrong_colour_steps(i_values, str_param, text):
    with pytest.raises(BadGoal, match=text):
        light_goals.colour_steps([0.5, 1.0], i_values, str_param)


@pytest.mark.parametrize("times", [[], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [-1.0], [float("nan")], [float("inf")]])
def test_times_rise_from_above_zero(times):
    with pytest.raises(BadGoal, match="field times"):
        light_goals.require_times(times)


def test_rising_times_pass():
    light_goals.require_times([0.1, 0.2, 5.0])


@pytest.mark.parametrize("value, zero, fine", [(0.0, True, True), (0.0, False, False), (1.0, False, True)])
def test_zero_seconds_are_for_some_only(value, zero, fine):
    if fine:
        light_goals.require_seconds("duration", value, zero)
    else:
        with pytest.raises(BadGoal, match="field duration: 0.0 is not allowed: more than 0 s"):
            light_goals.require_seconds("duration", value, zero)


@pytest.mark.parametrize("value", [-1.0, float("nan"), float("inf")])
def test_seconds_are_finite_and_not_negative(value):
    with pytest.raises(BadGoal, match="field rotation_time"):
        light_goals.require_seconds("rotation_time", value, zero=True)


@pytest.mark.parametrize("angle", [-1, 361])
def test_angles_go_round_once(angle):
    with pytest.raises(BadGoal, match=r"field angle: .* 0\.\.360 deg"):
        light_goals.require_angle(angle)
    light_goals.require_angle(360)
