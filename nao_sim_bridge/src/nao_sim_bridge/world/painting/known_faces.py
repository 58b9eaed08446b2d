"""The people whose faces can be seen, from `config/faces.json`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import Any

from nao_sim_bridge.base.config import check_keys, config_file, read_json, vector
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.model.robot_model import frozen_mapping

FILE = "faces.json"
HAIR_STYLES = ("short", "fringe", "long", "parted", "curly", "bald")
GLASSES = ("none", "round", "square")
_CHOICES = {"hair_style": HAIR_STYLES, "glasses": GLASSES}
_SIZES = {"skin": 3, "hair": 3, "iris": 3, "eyes": 3, "brows": 3, "nose": 2, "mouth": 3, "lips": 3, "clothes": 3}
HEAD_HALF_HEIGHT = 1.45
"""Half the height of a head in halves of its width."""


@dataclass(frozen=True)
class FaceLook:
    """How somebody looks.

    Lengths are shares of half the width of the head, colours (r, g, b) in 0..1; the file says what each number means.
    """

    skin: tuple[float, ...]
    hair: tuple[float, ...]
    hair_style: str
    hairline: float
    iris: tuple[float, ...]
    eyes: tuple[float, ...]
    brows: tuple[float, ...]
    nose: tuple[float, ...]
    mouth: tuple[float, ...]
    lips: tuple[float, ...]
    jaw: float
    beard: float
    moustache: float
    glasses: str
    lashes: float
    age: float
    blush: float
    clothes: tuple[float, ...]


@lru_cache(maxsize=None)
def load_faces() -> Mapping[str, FaceLook]:
    """The people by name, read once.

    Raises:
        ConfigError: If the file has a wrong, unknown or missing entry.
    """
    table = check_keys(read_json(config_file(FILE)), FILE, ("_meta", "people"))
    return frozen_mapping({name: _read(entry, f"{FILE}: people.{name}") for name, entry in table["people"].items()})


def _read(entry: Any, where: str) -> FaceLook:
    names = [field.name for field in fields(FaceLook)]
    check_keys(entry, where, names)
    return FaceLook(**{name: _value(name, entry[name], f"{where}.{name}") for name in names})


def _value(name: str, value: Any, where: str) -> Any:
    if name in _CHOICES:
        if value not in _CHOICES[name]:
            raise ConfigError(where, f"is {value!r}, allowed is one of {', '.join(_CHOICES[name])}")
        return value
    if name in _SIZES:
        return tuple(vector(value, where, _SIZES[name]).tolist())
    return float(vector([value], where, 1)[0])
