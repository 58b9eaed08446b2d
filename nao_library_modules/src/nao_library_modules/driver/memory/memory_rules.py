"""Keys of the robot's memory: names, types, access, and the rules that say which are published. No ROS."""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ...core.errors import BadGoal, did_you_mean
from ...core.fields import limit, require_zero_or
from ...core.memory_functions import json_of, value_of_json
from ...core.robot import ask

FIRST = "key_"
"""Before a name that does not begin with a letter, which ROS asks for."""


def is_pattern(text: str) -> bool:
    return "*" in text or "?" in text


def matches(key: str, pattern: str) -> bool:
    """Whether a key matches a pattern or equals it; upper and lower case matter."""
    # Brackets are no wildcards here: keys may have some.
    return fnmatch.fnmatchcase(key, pattern.replace("[", "[[]"))


def matching(keys: Iterable[str], pattern: str) -> list[str]:
    """The keys that match a pattern, sorted; an empty one matches all."""
    return sorted(key for key in keys if not pattern or matches(key, pattern))


def topic_of(key: str) -> str:
    """A legal name of ROS that resembles a key: illegal characters become underscores."""
    parts = [re.sub(r"[^A-Za-z0-9_]", "_", part) for part in key.split("/") if part]
    name = "/".join(parts) or "_"
    return name if name[0].isascii() and name[0].isalpha() else FIRST + name


def topics_of(keys: Iterable[str], taken: Iterable[str]) -> dict[str, str]:
    """A topic for each key, distinct from each other and from `taken`."""
    used = set(taken)
    topics = {}
    for key in keys:
        plain = name = topic_of(key)
        count = 1
        while name in used:
            count += 1
            name = f"{plain}_{count}"
        used.add(name)
        topics[key] = name
    return topics


BOOL, INT, FLOAT, TEXT = "bool", "int", "float", "string"
INTS, FLOATS, TEXTS = "int[]", "float[]", "string[]"
KINDS = (BOOL, INT, FLOAT, TEXT, INTS, FLOATS, TEXTS)
LIST, OBJECT, NULL = "list", "object", "null"
"""What a value may be besides; a message has it as JSON in a text."""
LARGEST = 2**31
"""Whole numbers of messages are below this."""


def type_of(value: Any) -> str:
    """The type of a value: one of KINDS, or LIST, OBJECT or NULL."""
    if value is None:
        return NULL
    if isinstance(value, bool):
        return BOOL
    if isinstance(value, int):
        return INT
    if isinstance(value, float):
        return FLOAT
    if isinstance(value, str):
        return TEXT
    if isinstance(value, (list, tuple)):
        return _list_type(value)
    return OBJECT


def kind_of(value: Any) -> str:
    """The kind of message for a value: one of KINDS, TEXT for values without a message of their own."""
    kind = type_of(value)
    if kind in (INT, INTS) and not _fits_int(value):
        return TEXT
    return kind if kind in KINDS else TEXT


def converted(value: Any, kind: str) -> Any:
    """A value as a message of some kind carries it; None if it cannot.

    Numbers widen (int to float, true to 1), and any value is a text. The other way would lose something.
    """
    if kind == TEXT:
        return value if isinstance(value, str) else json_of(value)
    if kind == BOOL:
        return value if isinstance(value, bool) else None
    if kind == INT:
        return int(value) if isinstance(value, int) and _fits_int(value) else None
    if kind == FLOAT:
        return float(value) if isinstance(value, (bool, int, float)) else None
    return _converted_list(value, kind)


def parse_value(text: str) -> Any:
    """A value from JSON; a text that is no JSON is itself."""
    try:
        return value_of_json(text)
    except ValueError:
        return text


def _list_type(values: Sequence[Any]) -> str:
    kinds = {type_of(value) for value in values}
    if kinds == {INT}:
        return INTS
    if kinds and kinds <= {INT, FLOAT}:
        return FLOATS
    return TEXTS if kinds == {TEXT} else LIST


def _converted_list(values: Any, kind: str) -> list[Any] | None:
    if not isinstance(values, (list, tuple)):
        return None
    single = {INTS: INT, FLOATS: FLOAT}.get(kind)
    if single is None:
        return list(values) if all(isinstance(value, str) for value in values) else None
    parts = [converted(value, single) for value in values]
    return None if any(part is None for part in parts) else parts


def _fits_int(value: Any) -> bool:
    return all(-LARGEST <= each < LARGEST for each in (value if isinstance(value, (list, tuple)) else (value,)))


MEMORY = "ALMemory"
BATCH = 500
"""Keys in one question."""


class MemoryAccess:
    """Calls ALMemory; raises NaoError if that fails. Any thread may call."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot

    def ask(self, method: str, *arguments: Any) -> Any:
        return ask(self._robot, MEMORY, method, *arguments)

    def values(self, keys: Sequence[str]) -> list[Any]:
        """Values of keys, in order; None for one without."""
        found: list[Any] = []
        for begin in range(0, len(keys), BATCH):
            found += self.ask("getListData", list(keys[begin : begin + BATCH]))
        return found

    def known(self) -> dict[str, bool]:
        """Key -> whether it is an event, of all keys of the robot."""
        methods = ("getDataListName", "getEventList", "getMicroEventList")
        calls = [self._robot.proxy(MEMORY).call_async(method) for method in methods]
        keys, *events = [call.result(timeout=ANSWER_LIMIT) for call in calls]
        event_names = {name for names in events for name in names}
        return {name: name in event_names for name in (*keys, *sorted(event_names))}

    def write(self, key: str, value: Any, as_event: bool) -> None:
        if as_event:
            self.ask("raiseEvent", key, value)
        else:
            self.ask("insertListData", [[key, value]])  # insertData has overloads, and would make 1 of true

    def find(self, pattern: str) -> dict[str, Any]:
        """Key -> value, of the keys that match a pattern; None for one without. Raises BadGoal if none matches."""
        known = self.known()
        keys = matching(known, check_pattern(pattern))
        if not keys:
            several = is_pattern(pattern)
            problem = f"no key matches {pattern!r}" if several else f"key {pattern!r} not found"
            raise BadGoal("pattern", pattern, "keys of the robot's memory", problem + did_you_mean(pattern, known))
        return dict(zip(keys, self.values(keys)))


def check_pattern(pattern: str, field: str = "pattern") -> str:
    """The pattern or key itself; raises BadGoal if it is empty."""
    if not pattern.strip():
        raise BadGoal(field, pattern, "a key, or several with * and ?", problem="it is empty")
    return pattern


RATE = limit("sampling rate")
"""Hz, the most that rules may ask for."""


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
