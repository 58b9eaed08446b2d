"""Gait parameters by NAOqi's names, and the file of the walk."""

from __future__ import annotations

import copy
import dataclasses
import json
import math

import pytest

from nao_sim_bridge.base.errors import BadValue, ConfigError, UnknownName
from nao_sim_bridge.walk import gait as gait_module
from nao_sim_bridge.walk.clipping import step_limits
from nao_sim_bridge.walk.gait import FIELDS, Gait, feet_gait, parameters, walk_file
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.settings import load_walk_settings

LOADERS = (walk_file, parameters, load_walk_settings, step_limits)


@pytest.mark.parametrize("name", FIELDS)
def test_a_value_within_its_range_counts_for_both_feet_or_for_one(name):
    known, field = parameters()[name], FIELDS[name]
    for value in (known.minimum, known.maximum):
        both, left, right = (feet_gait({prefix + name: value}) for prefix in ("", "Left", "Right"))
        assert both.left == both.right and getattr(both.left, field) == value
        assert getattr(left.of(LEFT), field) == value and left.of(RIGHT) == Gait()
        assert getattr(right.of(RIGHT), field) == value and right.of(LEFT) == Gait()


@pytest.mark.parametrize("name", FIELDS)
def test_values_out_of_range_are_refused_with_the_range(name):
    known = parameters()[name]
    for prefix in ("", "Left", "Right"):
        for value in (known.minimum - 1e-3, known.maximum + 1e-3, math.nan, math.inf, "0.02", None, True):
            with pytest.raises(BadValue, match=f"{prefix}{name}.*{known.minimum:g} to {known.maximum:g}"):
                feet_gait({prefix + name: value})


def test_what_is_fixed_or_unknown_or_no_frequency_is_refused():
    for name, known in parameters().items():
        if not known.settable:
            with pytest.raises(BadValue, match=f"{name}.*fixed at {known.default:g}"):
                feet_gait({name: known.default})
    for name in ("MaxStepXX", "Left", "leftMaxStepX", "LeftRightMaxStepX", "LeftFrequency", ""):
        with pytest.raises(UnknownName):
            feet_gait({name: 0.02})
    for frequency in (-0.1, 1.1, math.nan, "1", False):
        with pytest.raises(BadValue, match="Frequency"):
            feet_gait({"Frequency": frequency})


def test_steps_are_between_the_longest_and_the_shortest_period_for_each_foot():
    assert (Gait().period(1.0), Gait().period(0.0)) == pytest.approx((0.42, 0.6))
    assert Gait(max_step_frequency=0.0).period(1.0) == pytest.approx(0.6)
    assert Gait(max_step_frequency=0.5).period(0.5) == pytest.approx(0.6 - 0.25 * 0.18)
    made = feet_gait({"LeftMaxStepFrequency": 0.0, "Frequency": 0.5})
    assert (made.period(LEFT), made.period(RIGHT)) == pytest.approx((0.6, 0.51))


@pytest.fixture
def file_of(monkeypatch, tmp_path):
    """Puts the changed copy `file_of.content` in the place of `walk.json`."""
    content = copy.deepcopy(dict(walk_file()))

    def write():
        (tmp_path / "walk.json").write_text(json.dumps(content), encoding="utf-8")
        monkeypatch.setattr(gait_module, "config_file", lambda name: tmp_path / name)
        for loader in LOADERS:
            loader.cache_clear()

    write.content = content
    yield write
    for loader in LOADERS:
        loader.cache_clear()


def test_every_number_is_taken_from_its_own_place(file_of):
    """Each entry of the section, made a number of its own, turns up in the settings once."""
    numbers = iter(range(1, 100))

    def number(entry):
        return {key: number(value) if isinstance(value, dict) else next(numbers) for key, value in entry.items()}

    engine = file_of.content["engine"] = number(file_of.content["engine"])
    file_of()
    found = load_walk_settings()
    assert (found.foot_separation, found.min_foot_separation) == (0.1, 0.088)
    flat = [v for value in dataclasses.astuple(found) for v in (value if isinstance(value, tuple) else (value,))]
    assert sorted(flat) == list(range(1, len(flat) + 1))
    assert found.change == tuple(engine["change_per_step"][key] for key in ("x_m", "y_m", "yaw_rad"))
    for names, group, keys in (
        (("stance_time", "push_time", "shift_time"), "times", ("stance_s", "push_s", "shift_s")),
        (("settle_time", "stand_time"), "times", ("settle_s", "stand_s")),
        (("observer_place", "observer_speed"), "observer", ("place", "speed")),
        (("shift_gain", "shift_smoothing", "shift_limit"), "com_shift", ("gain", "smoothing", "limit_m")),
        (("loaded", "latest", "sink"), "landing", ("loaded_n", "latest_s", "sink_m")),
        (("habit_time", "habit_within", "habit_limit"), "habit", ("time_s", "within_m", "limit_m")),
        (("calm_from", "calm_range"), "calm", ("from_m", "range_m")),
        (("turn_hold", "turn_hold_limit"), "hold", ("turn", "turn_limit_rad")),
        (("aside_hold", "aside_hold_limit"), "hold", ("aside", "aside_limit_m")),
        (("arm_swing", "arm_ease"), "arms", ("swing_rad", "ease_s")),
    ):
        assert [getattr(found, name) for name in names] == [engine[group][key] for key in keys]


@pytest.mark.parametrize(
    "load, change, text",
    [
        (load_walk_settings, lambda c: c["engine"]["times"].pop("push_s"), "engine.times.*push_s"),
        (load_walk_settings, lambda c: c["engine"].update(com_hight_m=1), "com_hight_m.*com_height_m"),
        (walk_file, lambda c: c.pop("gait_parameters"), "gait_parameters"),
        (step_limits, lambda c: c["clipping"].update(left_foot_box=[[0.1, "a"]] * 4), "left_foot_box"),
        (parameters, lambda c: c["gait_parameters"]["StepHeight"].update(default=0.05), "StepHeight.*default"),
    ],
)
def test_what_is_wrong_in_the_file_is_named(file_of, load, change, text):
    change(file_of.content)
    file_of()
    with pytest.raises(ConfigError, match=text):
        load()
