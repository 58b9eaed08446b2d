"""Bounds of numbers that come in from outside, by kind: `config/limits.json`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Mapping

from nao_sim_bridge.base.config import check_keys, config_file, read_json
from nao_sim_bridge.base.errors import BadValue, ConfigError

FILE = "limits.json"


@dataclass(frozen=True)
class Kind:
    """A kind of number.

    Attributes:
        name: What it is called.
        unit: Of its bounds.
        lowest: The least it may be.
        highest: The most it may be.
        smallest: How near to 0 it may be when it is not 0.
        infinite: Whether infinity has a meaning.
    """

    name: str
    unit: str
    lowest: float = -math.inf
    highest: float = math.inf
    smallest: float = 0.0
    infinite: bool = False

    @property
    def anything(self) -> bool:
        """Whether every number is allowed, also one that is not finite."""
        return self.lowest == -math.inf and self.highest == math.inf

    def fits(self, number: float) -> bool:
        if self.lowest <= number <= self.highest:
            return number == 0.0 or abs(number) >= self.smallest
        return self.anything or (self.infinite and number == math.inf)

    def __str__(self) -> str:
        unit = "" if self.unit == "none" else f" {self.unit}"
        least = f", and 0 or at least {self.smallest:g} away from it" if self.smallest else ""
        endless = ", or infinity" if self.infinite else ""
        return f"a finite number, {self.lowest:g} to {self.highest:g}{unit}{least}{endless}"


@lru_cache(maxsize=None)
def kinds() -> Mapping[str, Kind]:
    fields = ("lowest", "highest", "smallest", "infinite")
    return {
        name: Kind(name, **check_keys(entry, f"{FILE}: kinds.{name}", ("unit",), fields))
        for name, entry in declared()["kinds"].items()
    }


@lru_cache(maxsize=None)
def declared() -> Mapping[str, Any]:
    content = read_json(config_file(FILE))
    return check_keys(content, FILE, ("_source", "kinds", "parameters", "methods", "texts", "fields", "world"))


def kind(name: str) -> Kind:
    """A kind by its name.

    Raises:
        ConfigError: There is none of that name.
    """
    if name not in kinds():
        raise ConfigError(FILE, f"unknown kind {name!r}")
    return kinds()[name]


OTHER = "number"
"""The kind of what the file does not name."""


def field_kind(field: str) -> Kind:
    """The kind of number that a field of a ROS message has."""
    return kind(declared()["fields"].get(field, OTHER))


def world_kind(key: str) -> Kind:
    """The kind of number that stands under a key of a world file, or in an option of that name."""
    return kind(declared()["world"].get(key, OTHER))


def check_world(content: Any, where: str) -> None:
    """Look at every number of a world file, or of a part of it.

    Raises:
        BadValue: One of the numbers is out of the bounds of its key.
    """
    left = [(where, kind(OTHER), content)]
    while left:
        where, wanted, value = left.pop()
        if isinstance(value, dict):
            left.extend((f"{where}.{key}", world_kind(str(key)), inner) for key, inner in reversed(list(value.items())))
        elif isinstance(value, list):
            left.extend((f"{where}[{i}]", wanted, inner) for i, inner in reversed(list(enumerate(value))))
        else:
            check(value, where, wanted)


def check(value: Any, field: str, wanted: Kind) -> None:
    """Look at every number in a value, also in lists and mappings.

    Raises:
        BadValue: One of them is out of bounds.
    """
    if wanted.anything:
        return
    left = [value]  # no recursion: what comes from outside may be nested deeply
    while left:
        inner = left.pop()
        if isinstance(inner, (int, float)):
            if not wanted.fits(inner):
                place, number = _first_misfit(value, field, wanted)
                raise BadValue(place, number, str(wanted))
        elif isinstance(inner, (list, tuple)):
            left.extend(inner)
        elif isinstance(inner, dict):
            left.extend(inner.values())


def _first_misfit(value: Any, field: str, wanted: Kind) -> tuple[str, float]:
    """The first number in a value that is out of bounds, and its place; there is one."""
    left = [(field, value)]
    while True:
        place, value = left.pop()
        if isinstance(value, (int, float)) and not wanted.fits(value):
            return place, value
        if isinstance(value, (list, tuple, dict)):
            entries = list(value.items() if isinstance(value, dict) else enumerate(value))
            left.extend((f"{place}[{key!r}]", inner) for key, inner in reversed(entries))
