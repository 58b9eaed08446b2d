"""Bounds of the numbers that come in over NAOqi: declared for each parameter, and kept."""

from __future__ import annotations

import inspect
import math
import re

import pytest

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.limits import check, declared, kinds
from nao_sim_bridge.naoqi.binding import limits
from nao_sim_bridge.naoqi.binding.api import FILE, module_methods, older_tables
from nao_sim_bridge.naoqi.binding.binding import published_methods
from nao_sim_bridge.naoqi.binding.wire_types import fitted
from nao_sim_bridge.naoqi.system.nao_simulation import NaoSimulation

NUMERIC = ("int", "float", "ALValue")
BAD = [math.nan, -math.inf, 1.7e308, -1.7e308]


def numeric_parameters():
    """Module, method and parameter of everything in NAOqi's table, and of NaoSimulation, that may hold numbers."""
    for module in {*read_json(config_file(FILE)), *older_tables()["modules"]}:
        if not module.startswith("_"):
            for name, method in published_methods(module).items():
                for overload in method.overloads:
                    for kind, parameter in zip(overload.types, overload.names):
                        if any(number in kind for number in NUMERIC):
                            yield module, name, parameter
    for name, method in inspect.getmembers(NaoSimulation, inspect.isfunction):
        for parameter in inspect.signature(method).parameters.values():
            if any(number in str(parameter.annotation) for number in NUMERIC):
                yield NaoSimulation.__name__, name, parameter.name


def test_each_parameter_that_takes_numbers_is_declared_and_nothing_else():
    found = list(numeric_parameters())
    assert len(found) > 400
    assert {parameter for _, _, parameter in found} == set(declared()["parameters"])
    own = {(method, parameter) for method, own in declared()["methods"].items() for parameter in own}
    assert own <= {(f"{module}.{method}", parameter) for module, method, parameter in found}
    used = {limits.kind_of(*parameter).name for parameter in found}
    assert used <= set(kinds()) and "anything" in used


def test_no_number_gets_far_out_but_where_it_is_only_data():
    for module, name, parameter in numeric_parameters():
        kind = limits.kind_of(module, name, parameter)
        for bad in BAD:
            assert kind.fits(bad) == kind.anything
        assert kind.fits(math.inf) == (kind.anything or kind.infinite)
        assert kind.fits(0) and kind.fits(1) and (module == "ALMemory" or kind.fits(0.5))


@pytest.mark.parametrize(
    "value, place",
    [
        (1e4, ""),
        ([1e4], "[0]"),
        ([[0.0, [1e4, 1e5]]], "[0][1][0]"),
        ({"a": (0.0, 1e4)}, "['a'][1]"),
        ([1.0, math.nan], "[1]"),
        (-(2**70), ""),
    ],
)
def test_a_number_out_of_bounds_is_told_wherever_it_is(value, place):
    told = rf"^angles{re.escape(place)} is .*, allowed is a finite number, -1000 to 1000 rad$"
    with pytest.raises(BadValue, match=told):
        check(value, "angles", kinds()["angle"])
    check(value, "data", kinds()["anything"])


def test_deeply_nested_values_are_looked_at():
    value = [1e9]
    for _ in range(2000):
        value = [value]
    with pytest.raises(BadValue):
        check(value, "angles", kinds()["angle"])


def test_a_time_is_nothing_or_long_enough_to_be_one():
    time = kinds()["time"]
    assert not time.fits(1e-320) and not time.fits(-1e-7)
    assert time.fits(0.0) and time.fits(1e-6) and time.fits(86400)


def test_arguments_are_looked_at_before_a_method_gets_them():
    interpolation = module_methods("ALMotion")["angleInterpolation"]
    with pytest.raises(BadValue, match=r"angleLists\[0\] is 1.7e.308"):
        fitted(interpolation, ["HeadYaw", [1.7e308, -1.7e308], [1.0, 2.0], True], "ALMotion")
    with pytest.raises(BadValue, match=r"timeLists\[0\] is 1.7e.308, .* 86400 s"):
        fitted(interpolation, ["HeadYaw", [0.1], [1.7e308], True], "ALMotion")
    kept = fitted(module_methods("ALMemory")["insertData"], ["key", math.inf], "ALMemory")
    assert kept == ["key", math.inf]


def test_the_table_tells_bounds_and_where_they_hold():
    rows = {row.kind: row for row in limits.table()}
    assert list(rows) == list(kinds())
    assert rows["time"][1:5] == (-86400, 86400, "s", 1e-6)
    assert "duration" in rows["time"].where and "ALAudioPlayer.goTo position" in rows["time"].where
    assert "field force" in rows["force"].where and "world mass" in rows["mass"].where
    assert sum(len(row.where) for row in rows.values()) > 150


TOLD = {r"\bin (m|s|ms|rad|Hz|degC)\b": None, r"0\.\.1\b": "(0..1 is usual)", r"\b0 to 100\b|\bpercentage\b": "%"}
"""How the summary of a method tells a unit -> the unit, where not as it stands there."""


def units_in(summary):
    """Units that a text names."""
    return {unit or found for pattern, unit in TOLD.items() for found in re.findall(pattern, summary)}


def test_a_unit_is_one_and_that_of_the_method():
    """Also where methods call different things by one name: x is a way, a velocity or a share of one."""
    assert not [kind.name for kind in kinds().values() if " or " in kind.unit or "%," in kind.unit]
    for method, x, theta in (
        ("ALMotion.moveTo", "m", "rad"), ("ALMotion.walkTo", "m", "rad"), ("ALMotion.stepTo", "m", "rad"),
        ("ALNavigation.moveTo", "m", "rad"), ("ALNavigation.navigateTo", "m", "rad"),
        ("ALMotion.move", "m/s", "rad/s"), ("ALNavigation.move", "m/s", "rad/s"),
        ("ALMotion.moveToward", "(0..1 is usual)", "(0..1 is usual)"),
        ("ALMotion.setWalkTargetVelocity", "(0..1 is usual)", "(0..1 is usual)"),
    ):  # fmt: skip
        module, name = method.split(".")
        told = [limits.kind_of(module, name, parameter).unit for parameter in ("x", "y", "theta")]
        assert told == [x, x, theta], method
    with pytest.raises(BadValue, match="theta is .*, -1e.06 to 1e.06 rad$"):
        fitted(module_methods("ALMotion")["moveTo"], [0.1, 0.0, 1e9], "ALMotion")
    for what, unit in (("Velocity", "rad/s"), ("Acceleration", "rad/s²")):
        assert limits.kind_of("ALTracker", f"setMaximum{what}", f"p{what}").unit == unit


def test_a_method_whose_summary_tells_a_unit_has_a_number_of_that_unit():
    looked_at, wrong = 0, []
    for module in {*read_json(config_file(FILE)), *older_tables()["modules"]}:
        methods = {} if module.startswith("_") else published_methods(module)
        for name, method in methods.items():
            numbers = {
                parameter
                for overload in method.overloads
                for kind, parameter in zip(overload.types, overload.names)
                if kind in ("int", "float") and parameter != "paramValue"  # of several parameters, each with a unit
            }
            told = units_in(method.summary)
            if told and numbers and not name.startswith("get"):  # whose unit is that of the answer
                looked_at += 1
                units = {limits.kind_of(module, name, parameter).unit for parameter in numbers}
                if not told <= units:
                    wrong.append(f"{module}.{name}: {method.summary!r} has {told}, {numbers} are in {units}")
    assert looked_at > 20 and not wrong, "\n".join(wrong)
