"""The descriptions of all servers, against the servers themselves."""

from __future__ import annotations

import importlib
import inspect
import json
import math
import pkgutil
from functools import lru_cache

import pytest

import nao_library_modules.behaviors
from nao_library_modules.describe import COMMON, Description
from nao_library_modules.describe_fields import NO_UNIT
from nao_library_modules.describe_offline import offline_servers
from nao_library_modules.nao_basic import NaoBasic

SERVERS = {server.name: server for server in offline_servers()}
UNITS = {"s", "rad", "m", "deg", "%", "Hz", "kg", "rad/s", "m/s", "pixels", "frames a second", "samples a second"}


@lru_cache(maxsize=None)
def described(name):
    description = Description(SERVERS[name].module, SERVERS[name].action)
    return description, {function.name: function for function in description.functions()}


def argument(server, function, field):
    return next(a for a in described(server)[1][function].arguments if a.name == field)


def test_every_module_that_serves_an_action_is_described():
    assert {"NaoLights", "NaoMotion", "nao_audio_out", "nao_audio_in", "NaoVision", "NaoBehavior"} <= set(SERVERS)
    found = set()
    for package in (nao_library_modules, nao_library_modules.behaviors):
        for file in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
            if not file.ispkg:
                found |= {each for each in vars(importlib.import_module(file.name)).values() if inspect.isclass(each)}
    modules = {each for each in found if issubclass(each, NaoBasic) and each is not NaoBasic}
    assert modules == {type(server.module) for server in SERVERS.values()}


@pytest.mark.parametrize("name", sorted(SERVERS))
def test_functions_have_help_and_answers_and_arguments_types_help_and_units(name):
    description, functions = described(name)
    common = [a.name for a in description.common()]
    assert common == list(COMMON) and list(functions) == list(SERVERS[name].module.function_table)
    for function in functions.values():
        assert function.help.endswith((".", "...")) and function.answers, function.name
        assert not set(common) & {a.name for a in function.arguments}, "those of all functions are told once"
        for taken in function.arguments:
            where = (function.name, taken.name)
            assert taken.type and taken.help, where
            numeric = taken.type.startswith(("float", "int", "uint", "duration"))
            assert bool(taken.unit) == numeric, where
            assert not numeric or taken.unit == NO_UNIT or set(taken.unit.split(", ")) <= UNITS, (where, taken.unit)
            if taken.default:
                json.loads(taken.default)


def test_units_limits_and_choices_are_those_that_people_know():
    for server, function, field, unit, low, high in (
        ("NaoLights", "fade", "duration", "s", 0.0, math.nan),
        ("NaoLights", "setIntensity", "i_values", NO_UNIT, math.nan, math.nan),
        ("NaoMotion", "setAngles", "angles", "rad", math.nan, math.nan),
        ("NaoMotion", "goToPosture", "speed", NO_UNIT, 0.0, 1.0),
        ("NaoMotion", "moveTo", "values", "m, rad", math.nan, math.nan),
        ("NaoMotion", "recordMotion", "rate", "samples a second", 0.0, 100.0),
        ("nao_audio_out", "say", "volume", NO_UNIT, 0.0, 1.0),
        ("nao_audio_out", "setOutputVolume", "volume", "%", 0.0, 100.0),
        ("nao_audio_in", "listen", "timeout", "s", 0.0, 3600.0),
        ("NaoVision", "detectBall", "size", "m", 0.0, 100.0),
    ):
        taken = argument(server, function, field)
        assert taken.unit == unit, (function, field)
        assert (taken.minimum, taken.maximum) == pytest.approx((low, high), nan_ok=True), (function, field)
    assert "green" in argument("NaoLights", "setColor", "str_param").choices
    assert argument("NaoMotion", "getMoveConfig", "str_param").choices == ("Default", "Min", "Max")
