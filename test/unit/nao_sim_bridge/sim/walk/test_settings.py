"""Settings of the walk engine, and what is wrong with a file that does not hold them."""

from __future__ import annotations

import copy
import dataclasses
import json

import pytest

from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.walk import clipping, gait, settings
from nao_sim_bridge.sim.walk.clipping import step_limits
from nao_sim_bridge.sim.walk.gait import walk_file
from nao_sim_bridge.sim.walk.settings import load_walk_settings

LOADERS = (walk_file, load_walk_settings, step_limits)


@pytest.fixture
def file_of(monkeypatch, tmp_path):
    """Puts a file in the place of `walk.json`; without an argument, a copy of it to change."""
    content = copy.deepcopy(dict(walk_file()))

    def write(text=None):
        path = tmp_path / "walk.json"
        path.write_text(json.dumps(content) if text is None else text, encoding="utf-8")
        monkeypatch.setattr(gait, "config_file", lambda name: tmp_path / name)
        for loader in LOADERS:
            loader.cache_clear()

    write.content = content
    yield write
    for loader in LOADERS:
        loader.cache_clear()


def test_the_file_of_the_package_makes_sense():
    found = load_walk_settings()
    assert all(value is not None for value in dataclasses.astuple(found))
    assert 0.2 < found.com_height < 0.3
    assert 0.0 < found.double_support_share < 0.5
    assert 0.5 <= found.outer_turn <= 1.0
    assert found.steps_ahead >= 2
    assert min(found.change) > 0.0
    assert 0.0 < found.observer_speed < found.observer_place < 1.0
    assert (found.foot_separation, found.min_foot_separation) == (0.1, 0.088)


def test_every_number_is_taken_from_its_own_place(file_of):
    """Each entry of the section, made a number of its own, turns up in the settings once."""
    numbers = iter(range(1, 100))

    def number(entry):
        return {key: number(value) if isinstance(value, dict) else next(numbers) for key, value in entry.items()}

    engine = file_of.content["engine"] = number(file_of.content["engine"])
    file_of()
    found = load_walk_settings()
    flat = [v for value in dataclasses.astuple(found) for v in (value if isinstance(value, tuple) else (value,))]
    assert sorted(flat) == list(range(1, len(flat) + 1))
    assert found.change == tuple(engine["change_per_step"][key] for key in ("x_m", "y_m", "yaw_rad"))
    assert (found.stance_time, found.stand_time) == (engine["times"]["stance_s"], engine["times"]["stand_s"])
    assert (found.observer_place, found.observer_speed) == (engine["observer"]["place"], engine["observer"]["speed"])
    assert (found.turn_hold, found.aside_hold) == (engine["hold"]["turn"], engine["hold"]["aside"])
    assert (found.arm_swing, found.arm_ease) == (engine["arms"]["swing_rad"], engine["arms"]["ease_s"])


@pytest.mark.parametrize("group", ["times", "change_per_step", "observer", "com_shift", "landing", "hold", "arms"])
def test_a_group_must_be_complete_and_of_numbers(file_of, group):
    entry = file_of.content["engine"][group]
    key = next(iter(entry))
    value = entry.pop(key)
    file_of()
    with pytest.raises(ConfigError, match=f"engine.{group}.*{key}"):
        load_walk_settings()
    entry[key] = str(value) + " s"
    file_of()
    with pytest.raises(ConfigError, match=f"engine.{group}"):
        load_walk_settings()


def test_an_unknown_key_is_named_with_the_nearest_one(file_of):
    file_of.content["engine"]["com_hight_m"] = file_of.content["engine"].pop("com_height_m")
    file_of()
    with pytest.raises(ConfigError, match="com_hight_m.*com_height_m"):
        load_walk_settings()


@pytest.mark.parametrize("section", ["gait_parameters", "clipping", "engine"])
def test_a_missing_section_is_named(file_of, section):
    del file_of.content[section]
    file_of()
    with pytest.raises(ConfigError, match=section):
        walk_file()


@pytest.mark.parametrize("text", ["", "{", "[]"])
def test_a_file_that_cannot_be_read_is_named(file_of, text):
    file_of(text)
    with pytest.raises(ConfigError, match="walk.json"):
        walk_file()


@pytest.mark.parametrize("box", [[[0.1, 0.0]], [[0.1, "a"]] * 4, None])
def test_a_foot_is_an_outline_of_four_corners(file_of, box):
    file_of.content["clipping"]["left_foot_box"] = box
    file_of()
    with pytest.raises(ConfigError, match="left_foot_box"):
        step_limits()


def test_the_modules_read_the_same_file():
    assert clipping.walk_file is settings.walk_file is gait.walk_file
