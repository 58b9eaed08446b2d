"""Errors say what was wrong and what is allowed, and keep both for programs."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim import errors


def test_all_have_one_root():
    family = [errors.ConfigError, errors.UnknownName, errors.BadValue, errors.TaskKilled, errors.SimulationStopped]
    assert all(issubclass(kind, errors.SimulationError) for kind in family)
    assert issubclass(errors.SimulationError, RuntimeError)


def test_an_unknown_name_offers_the_closest():
    error = errors.UnknownName("joint", "HeadYow", ["RHipRoll", "HeadPitch", "HeadYaw"])
    assert (error.kind, error.name, error.close) == ("joint", "HeadYow", ["HeadYaw", "HeadPitch"])
    assert str(error) == "unknown joint 'HeadYow': did you mean 'HeadYaw' or 'HeadPitch'?"


def test_an_unknown_name_like_nothing_makes_no_guess():
    assert str(errors.UnknownName("joint", "zzz", ["HeadYaw"])) == "unknown joint 'zzz'"


@pytest.mark.parametrize("name", [3, None, ["HeadYaw"]])
def test_an_unknown_name_need_not_be_a_text(name):
    assert repr(name) in str(errors.UnknownName("joint", name, ["HeadYaw"]))


def test_a_bad_value_names_field_value_and_what_is_allowed():
    error = errors.BadValue("speed", -1.0, "above 0")
    assert (error.field, error.value, error.allowed) == ("speed", -1.0, "above 0")
    assert str(error) == "speed is -1.0, allowed is above 0"


def test_a_config_error_names_the_place():
    error = errors.ConfigError("physics.json: motor", "missing 'gain'")
    assert (error.where, error.problem) == ("physics.json: motor", "missing 'gain'")
    assert str(error) == "physics.json: motor: missing 'gain'"


def test_values_of_megabytes_are_shortened():
    text = str(errors.BadValue("name", "x" * 1000000, "a short one"))
    assert text.startswith("name is 'xxx") and text.endswith("xxx... (1000002 characters), allowed is a short one")
    assert len(text) < 400
    assert len(str(errors.UnknownName("joint", "x" * 1000000, ["HeadYaw"]))) < 400
