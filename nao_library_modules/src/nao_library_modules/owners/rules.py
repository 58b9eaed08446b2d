"""The calls of the robot that start something, and the calls that stop it, from `config/owned_calls.json`. No ROS."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from ..base.paths import config_file

FILE = "owned_calls.json"
FIRST, NONE = "first", "none"


@dataclass(frozen=True)
class OwnershipRule:
    """One kind of thing that goes on by itself."""

    what: str  # name of it, for texts
    module: str  # NAOqi module of the calls
    cure: tuple[str, str]  # module and method that stop it
    arguments: str  # what the cure takes of the arguments of the call: "names", "first" or "none"
    during: frozenset[str] = frozenset()  # methods that own it while they run
    begins: frozenset[str] = frozenset()  # methods after which it goes on
    ends: frozenset[str] = frozenset()  # methods that end what `begins` started
    seconds: float = 0.0  # how long it goes on after a method of `during` that has ended

    def cure_arguments(self, arguments: Sequence[Any]) -> list[Any]:
        if self.arguments == NONE or not arguments:
            return []
        first = arguments[0]
        if self.arguments == FIRST:
            return [first]
        return [[first] if isinstance(first, str) else [str(name) for name in first]]

    def stands_still(self, arguments: Sequence[Any]) -> bool:
        """Whether a method of `begins` ends the walk instead: all its speeds are 0."""
        speeds = [value for value in arguments if isinstance(value, (int, float)) and not isinstance(value, bool)]
        return bool(speeds) and not any(speeds)


@lru_cache(maxsize=1)
def rules() -> dict[tuple[str, str], OwnershipRule]:
    """Module and method of a call -> its rule."""
    owned = json.loads(config_file(FILE).read_text(encoding="utf-8"))["owned"]
    return {
        (rule.module, method): rule for rule in map(_rule, owned) for method in rule.during | rule.begins | rule.ends
    }


def _rule(entry: dict[str, Any]) -> OwnershipRule:
    named = {"from": "begins", "to": "ends"}
    fields = {named.get(name, name): value for name, value in entry.items()}
    for name in ("during", "begins", "ends"):
        fields[name] = frozenset(fields.get(name, ()))
    fields["cure"] = tuple(fields["cure"])
    return OwnershipRule(**fields)
