"""What users import is there, and nothing else is promised."""

from __future__ import annotations

import naoqi

SDK_NAMES = {"ALBroker", "ALModule", "ALProxy"}


def test_all_that_is_promised_is_there():
    assert SDK_NAMES <= set(naoqi.__all__)
    assert naoqi.__all__ == sorted(naoqi.__all__)
    assert all(hasattr(naoqi, name) for name in naoqi.__all__)


def test_every_error_of_the_family_can_be_imported_from_the_top():
    family = {name for name, value in vars(naoqi.errors).items() if isinstance(value, type)}
    family = {name for name in family if issubclass(vars(naoqi.errors)[name], naoqi.NaoError)}
    assert len(family) > 5
    assert family <= set(naoqi.__all__)


def test_a_star_import_brings_the_names_of_the_sdk():
    names = {}
    exec("from naoqi import *", names)
    assert set(names) >= SDK_NAMES
