"""Gait parameters by NAOqi's names."""

from __future__ import annotations

import copy
import math

import pytest

from nao_sim_bridge.sim.errors import BadValue, ConfigError, UnknownName
from nao_sim_bridge.sim.walk import gait
from nao_sim_bridge.sim.walk.gait import FIELDS, FeetGait, Gait, feet_gait, parameters
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT

SETTABLE = [name for name, parameter in parameters().items() if parameter.settable]
FIXED = [name for name, parameter in parameters().items() if not parameter.settable]


@pytest.fixture
def file_with(monkeypatch):
    """Puts another value into one entry of the file."""

    def change(name, key, value):
        content = copy.deepcopy(dict(gait.walk_file()))
        content["gait_parameters"][name][key] = value
        monkeypatch.setattr(gait, "walk_file", lambda: content)

    parameters.cache_clear()
    yield change
    parameters.cache_clear()


def test_nothing_asked_for_is_the_default():
    assert feet_gait({}) == FeetGait()
    for name, field in FIELDS.items():
        assert getattr(Gait(), field) == parameters()[name].default


def test_what_can_be_set_is_what_has_a_field():
    assert set(SETTABLE) == set(FIELDS)


@pytest.mark.parametrize("name", SETTABLE)
def test_a_value_counts_for_both_feet(name):
    known = parameters()[name]
    made = feet_gait({name: known.maximum})
    assert made.left == made.right
    assert getattr(made.of(LEFT), FIELDS[name]) == known.maximum


@pytest.mark.parametrize("name", SETTABLE)
@pytest.mark.parametrize("prefix, mine, other", [("Left", LEFT, RIGHT), ("Right", RIGHT, LEFT)])
def test_a_prefix_means_one_foot(name, prefix, mine, other):
    known = parameters()[name]
    made = feet_gait({prefix + name: known.maximum})
    assert getattr(made.of(mine), FIELDS[name]) == known.maximum
    assert made.of(other) == Gait()


def test_of_two_values_the_later_one_counts():
    made = feet_gait({"StepHeight": 0.03, "LeftStepHeight": 0.01})
    assert (made.left.step_height, made.right.step_height) == (0.01, 0.03)


@pytest.mark.parametrize("name", SETTABLE)
def test_the_ends_of_a_range_are_in_it(name):
    known = parameters()[name]
    for value in (known.minimum, known.maximum):
        assert getattr(feet_gait({name: value}).right, FIELDS[name]) == value


@pytest.mark.parametrize("name", SETTABLE)
@pytest.mark.parametrize("prefix", ["", "Left", "Right"])
def test_values_out_of_range_are_refused_with_the_range(name, prefix):
    known = parameters()[name]
    for value in (known.minimum - 1e-3, known.maximum + 1e-3, math.nan, math.inf, "0.02", None, True):
        with pytest.raises(BadValue, match=f"{known.minimum:g} to {known.maximum:g}") as refused:
            feet_gait({prefix + name: value})
        assert prefix + name in str(refused.value)


@pytest.mark.parametrize("name", FIXED)
def test_what_is_fixed_cannot_be_set(name):
    with pytest.raises(BadValue, match="fixed"):
        feet_gait({name: parameters()[name].default})


@pytest.mark.parametrize("name", ["MaxStepXX", "Left", "leftMaxStepX", "LeftRightMaxStepX", "LeftFrequency", ""])
def test_unknown_names_are_refused(name):
    with pytest.raises(UnknownName):
        feet_gait({name: 0.02})


@pytest.mark.parametrize("frequency", [-0.1, 1.1, math.nan, "1", False])
def test_a_frequency_out_of_range_is_refused(frequency):
    with pytest.raises(BadValue, match="Frequency"):
        feet_gait({"Frequency": frequency})


def test_steps_are_between_the_longest_and_the_shortest_period():
    assert Gait().period(1.0) == pytest.approx(0.42)
    assert Gait().period(0.0) == pytest.approx(0.6)
    assert Gait(max_step_frequency=0.0).period(1.0) == pytest.approx(0.6)
    assert Gait(max_step_frequency=0.5).period(0.5) == pytest.approx(0.6 - 0.25 * 0.18)


def test_each_foot_has_a_period_of_its_own():
    made = feet_gait({"LeftMaxStepFrequency": 0.0, "Frequency": 0.5})
    assert made.period(LEFT) == pytest.approx(0.6)
    assert made.period(RIGHT) == pytest.approx(0.51)


def test_a_default_outside_its_range_is_an_error_of_the_file(file_with):
    file_with("StepHeight", "default", 0.05)
    with pytest.raises(ConfigError, match="StepHeight.*default"):
        parameters()


def test_an_unknown_key_of_a_parameter_is_an_error_of_the_file(file_with):
    file_with("StepHeight", "maximum", 0.05)
    with pytest.raises(ConfigError, match="StepHeight.*maximum"):
        parameters()
