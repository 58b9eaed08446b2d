"""Errors of the sensors are read strictly."""

from __future__ import annotations

import json

import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.sensors import noise_settings as module
from nao_sim_bridge.sim.sensors.noise_settings import FILE, load_noise


@pytest.fixture
def load_changed(change_file):
    """Reads the file of the package after a change of its content."""

    def load(change):
        change_file(module, change)
        return load_noise()

    return load


def test_every_value_is_a_number_of_the_file():
    content = json.loads(config_file(FILE).read_text())
    settings = load_noise()
    assert {name: vars(getattr(settings, name)) for name in content if name != "_meta"} == {
        name: section for name, section in content.items() if name != "_meta"
    }


def test_an_encoder_has_4096_steps_a_turn():
    assert load_noise().joints.angle_step == pytest.approx(2 * 3.141592653589793 / 4096)


@pytest.mark.parametrize(
    "change, message",
    [
        (lambda c: c["feet"].pop("force"), f"{FILE}: feet: missing 'force'"),
        (lambda c: c["joints"].update(angel=1), "unknown key 'angel', did you mean 'angle'"),
        (lambda c: c["joints"].update(angle=-1), r"joints\.angle: is -1, allowed is 0 or more"),
        (lambda c: c["inertial"].update(angle_wander_time_s=0), r"angle_wander_time_s: is 0, allowed is above 0"),
        (lambda c: c["inertial"].update(gyroscope="much"), r"inertial\.gyroscope: .*not numbers"),
    ],
)
def test_wrong_entries_are_refused_with_their_place(load_changed, change, message):
    with pytest.raises(ConfigError, match=message):
        load_changed(change)
