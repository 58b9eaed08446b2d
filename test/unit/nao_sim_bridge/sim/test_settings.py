"""Settings of the physics are read strictly."""

from __future__ import annotations

import json

import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim import settings as module
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.settings import FILE, load_settings

SECTIONS = ("motor", "contact", "head", "battery")


@pytest.fixture
def load_changed(change_file):
    """Reads the file of the package after a change of its content."""

    def load(change):
        change_file(module, change)
        return load_settings()

    return load


def test_a_tick_is_a_whole_number_of_steps():
    settings = load_settings()
    assert settings.tick_s == settings.time_step_s * settings.steps_per_tick
    # ALMotion's own cycle is 10 to 20 ms: a command must not wait longer here.
    assert 0.002 <= settings.tick_s <= 0.02


def test_every_value_is_a_number_of_the_file():
    content = json.loads(config_file(FILE).read_text())
    settings = load_settings()
    for name, value in content.items():
        if name in SECTIONS:
            # Lists of the file are tuples here, which nobody can change.
            assert json.loads(json.dumps(vars(getattr(settings, name)))) == value
        elif name != "_meta":
            assert getattr(settings, name) == value


def test_an_unknown_key_is_refused_with_the_closest(load_changed):
    with pytest.raises(ConfigError, match="unknown key 'gravity', did you mean 'gravity_m_s2'"):
        load_changed(lambda content: content.update(gravity=9.81))


@pytest.mark.parametrize("section", SECTIONS)
def test_a_missing_key_is_refused_with_its_section(load_changed, section):
    with pytest.raises(ConfigError, match=rf"{FILE}: {section}: missing"):
        load_changed(lambda content: content[section].popitem())
