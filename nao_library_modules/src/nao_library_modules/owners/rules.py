"""Which calls of the robot set something going, and what stops it. Read from `config/owned_calls.json`. No ROS."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from ..base.paths import config_file

FILE = "owned_calls.json"
NAMES, FIRST, NONE = "names", "first", "none"


@dataclass(frozen=True)
class Rule:
    """One kind of thing that goes on by itself.

    Attributes:
        what: Name of it, for texts.
        module: NAOqi module of the calls.
        during: Methods that own it while they run.
        begins: Methods after which it goes on.
        ends: Methods that end what `begins` set going.
        seconds: How long it goes on after a method of `during` that has ended, s.
        cure: Module and method that stop it.
        arguments: What the cure takes of the arguments of the call: "names", "first" or "none".
    """

    what: str
    module: str
    cure: tuple[str, str]
    arguments: str
    during: frozenset[str] = frozenset()
    begins: frozenset[str] = frozenset()
    ends: frozenset[str] = frozenset()
    seconds: float = 0.0

    def cure_arguments(self, arguments: Sequence[Any]) -> list[Any]:
        """What the cure of a call takes."""
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
def rules() -> dict[tuple[str, str], Rule]:
    """Module and method of a call -> its rule."""
    told = json.loads(config_file(FILE).read_text(encoding="utf-8"))["owned"]
    return {(rule.module, method): rule for rule in map(_rule, told) for method in _methods(rule)}


def _rule(told: dict[str, Any]) -> Rule:
    named = {"from": "begins", "to": "ends"}
    fields = {named.get(name, name): value for name, value in told.items()}
    for name in ("during", "begins", "ends"):
        fields[name] = frozenset(fields.get(name, ()))
    fields["cure"] = tuple(fields["cure"])
    return Rule(**fields)


def _methods(rule: Rule) -> Iterable[str]:
    return rule.during | rule.begins | rule.ends
