"""Rules: which keys of the robot's memory are watched, and how. No ROS."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...base.field_checks import require_zero_or
from ...base.limits import limit
from .memory_access import check_pattern
from .memory_names import is_pattern, matches
from .memory_values import KINDS

RATE = limit("sampling rate")
"""Hz, above which nobody asks."""


@dataclass(frozen=True)
class MemoryRule:
    """How keys are watched."""

    pattern: str  # a key, or several with * and ?
    rate: float = 0.0  # most messages a second and key, Hz; 0: the default
    kind: str = ""  # of message; empty: by value
    on: bool = True  # whether they are watched

    def check(self) -> None:
        """Raises BadGoal for a wrong field."""
        check_pattern(self.pattern)
        require_zero_or("rate", self.rate, RATE)
        if self.kind and self.kind not in KINDS:
            raise BadGoal("type", self.kind, f"one of {', '.join(KINDS)}, or nothing")


class MemoryRules:
    """Rules in the order in which they were made: the last one that matches a key counts. For one lock."""

    def __init__(self) -> None:
        self._rules: list[MemoryRule] = []

    def add(self, rule: MemoryRule) -> None:
        """Add a rule; it replaces older ones for the same pattern, or for keys that it covers."""
        self._rules = [r for r in self._rules if r.pattern != rule.pattern and not self._covers(rule, r)]
        if rule.on or any(r.on for r in self._rules):
            self._rules.append(rule)
        else:
            self._rules.clear()

    def copy(self) -> MemoryRules:
        other = MemoryRules()
        other._rules = list(self._rules)
        return other

    def all(self) -> list[MemoryRule]:
        """The rules, the oldest first."""
        return list(self._rules)

    def rule_for(self, key: str) -> MemoryRule | None:
        """The rule by which a key is watched; None if it is not."""
        found = next((rule for rule in reversed(self._rules) if matches(key, rule.pattern)), None)
        return found if found is not None and found.on else None

    def wanted_of(self, known: Iterable[str]) -> dict[str, MemoryRule]:
        """Key -> its rule, of all keys to watch: of those `known` at the robot, and all that a rule names."""
        named = [rule.pattern for rule in self._rules if rule.on and not is_pattern(rule.pattern)]
        found = {key: self.rule_for(key) for key in dict.fromkeys([*named, *known])}
        return {key: rule for key, rule in found.items() if rule is not None}

    @property
    def has_patterns(self) -> bool:
        """Whether keys that do not exist yet may be wanted."""
        return any(rule.on and is_pattern(rule.pattern) for rule in self._rules)

    def __bool__(self) -> bool:
        return bool(self._rules)

    @staticmethod
    def _covers(new: MemoryRule, old: MemoryRule) -> bool:
        by_name = not is_pattern(old.pattern) and matches(old.pattern, new.pattern)
        return not new.on and (by_name or new.pattern == "*")


def read_rules(entries: Any, parameter: str) -> list[MemoryRule]:
    """Rules from a parameter.

    `entries`: a list of keys and patterns, or of {key: ..., rate: ..., type: ...}; or a text with keys between commas
    or spaces. `parameter`: its name, for the text of an error. Raises NaoError if it is something else.
    """
    if isinstance(entries, str):
        entries = entries.replace(",", " ").split()
    allowed = "a list of keys, or of {key: ..., rate: ..., type: ...}"
    if not isinstance(entries, list):
        raise NaoError(f"{parameter} is {entries!r}: {allowed}")
    rules = []
    for place, entry in enumerate(entries):
        where = f"{parameter}[{place}]"
        fields = {"key": entry} if isinstance(entry, str) else entry
        if (
            not isinstance(fields, dict)
            or not isinstance(fields.get("key"), str)
            or set(fields) - {"key", "rate", "type"}
        ):
            raise NaoError(f"{where} is {entry!r}: {allowed}")
        rate = fields.get("rate", 0.0)
        if isinstance(rate, bool) or not isinstance(rate, (int, float)):
            raise NaoError(f"{where} has rate {rate!r}: Hz")
        rule = MemoryRule(fields["key"], float(rate), str(fields.get("type", "")))
        try:
            rule.check()
        except BadGoal as error:
            raise NaoError(f"{where}: {error}") from error
        rules.append(rule)
    return rules
