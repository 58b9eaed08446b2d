"""Rules: turn a description into a command or a plan. Patterns to match, and small functions.

    @rule(action, type="opening", gripper=one_of("left", "right"))
    def opening(gripper):
        return Command("manipulation", "open_gripper", side=gripper)

A rule matches when every key of its pattern does; other keys do not matter. Among the matching rules the highest
priority comes first, then the most specific, then the one added last: a user's rule precedes ours. A rule returns
solutions, in its order; those of the next rule follow.
"""

from __future__ import annotations

import inspect
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..language.failures import DesignatorError, PlanError
from ..language.short_text import short_repr
from .designator import KINDS, Designator, plain_key
from .patterns import Mismatch, Pattern, as_pattern

MOST_SHOWN = 4
DESIG = "desig"


@dataclass(frozen=True)
class Command:
    """A command of a process module: the solution of an action or a motion."""

    module: str
    name: str
    arguments: Mapping[str, Any] = field(default_factory=dict)

    def __str__(self) -> str:
        inside = ", ".join(f"{name}={short_repr(value)}" for name, value in self.arguments.items())
        return f"{self.module}: {self.name}({inside})"


def command(module: str, name: str, /, **arguments: Any) -> Command:
    """A command with its arguments by name."""
    return Command(module, name, arguments)


@dataclass(frozen=True)
class Rule:
    """A rule, as described at the top of this file.

    Attributes:
        solve: Receives the keys that its arguments are named after, and the designator as `desig`.
        solution, several, or None.
    """

    name: str
    kind: str
    patterns: Mapping[str, Pattern]
    solve: Callable[..., Any]
    priority: int = 0

    def __post_init__(self) -> None:
        for argument in self._arguments():
            if argument not in self.patterns and argument != DESIG:
                keys = ", ".join([*self.patterns, DESIG])
                raise PlanError(f"the rule {self.name!r}: its argument {argument} is none of its keys {keys}")

    def _arguments(self) -> list[str]:
        return list(inspect.signature(self.solve).parameters)

    def solutions(self, desig: Designator, values: Mapping[str, Any]) -> Iterable[Any]:
        """What it returns for a matching designator; `values` are those of `match`."""
        known = {**values, DESIG: desig}
        return _several(self.solve(**{name: known[name] for name in self._arguments()}))

    @property
    def exact(self) -> int:
        return sum(pattern.exact for pattern in self.patterns.values())

    def match(self, desig: Designator) -> dict[str, Any]:
        """The values of its keys; Mismatch with the key and what it wants."""
        values = {}
        for key, pattern in self.patterns.items():
            if key not in desig:
                if pattern.default is ...:
                    raise Mismatch(f"{key} is missing: {pattern.wanted}")
                values[key] = pattern.default
                continue
            try:
                values[key] = pattern.take(desig[key])
            except Mismatch:
                raise Mismatch(f"{key} is {short_repr(desig[key])}, not {pattern.wanted}") from None
        return values

    def keys_that_fit(self, desig: Designator) -> int:
        """Specificity of the matching keys, which ranks rules that nearly match."""
        fit = 0
        for key, pattern in self.patterns.items():
            try:
                if key in desig:
                    pattern.take(desig[key])
                    fit += pattern.exact
            except Mismatch:
                pass
        return fit


class Rules:
    """A set of rules; safe to use from any thread."""

    def __init__(self) -> None:
        self._rules: tuple[Rule, ...] = ()
        self._lock = threading.Lock()

    def add(self, new: Rule) -> Rule:
        """Add a rule; it replaces one of the same name and kind."""
        if new.kind not in KINDS:
            raise PlanError(f"the rule {new.name}: designators are of the kinds {', '.join(KINDS)}, not {new.kind!r}")
        with self._lock:
            others = [rule for rule in self._rules if (rule.name, rule.kind) != (new.name, new.kind)]
            self._rules = tuple(sorted([new, *others], key=lambda rule: (-rule.priority, -rule.exact)))
        return new

    def remove(self, old: Rule) -> None:
        with self._lock:
            self._rules = tuple(rule for rule in self._rules if rule is not old)

    def of(self, kind: str) -> list[Rule]:
        """Rules for a kind of designator, in the order in which they are tried."""
        return [rule for rule in self._rules if rule.kind == kind]

    def solutions(self, desig: Designator) -> Iterator[Any]:
        """Solutions of all matching rules.

        Raises DesignatorError if no rule matches; the text names the nearest, and the key on which each failed.
        """
        rules, misses = self.of(desig.kind), []
        for rule in rules:
            try:
                values = rule.match(desig)
            except Mismatch as mismatch:
                misses.append((rule, str(mismatch)))
                continue
            yield from rule.solutions(desig, values)
        if len(misses) == len(rules):
            raise DesignatorError(desig, _no_match(desig, misses))


RULES = Rules()
"""Those of this package, and what users add."""
Designator.by_rules = RULES.solutions


def rule(
    kind: str | tuple[str, ...],
    keys: Mapping[str, Any] | None = None,
    *,
    priority: int = 0,
    called: str = "",
    rules: Rules = RULES,
    **patterns: Any,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function as a rule.

    Args:
        kind: Of designators; several in a tuple.
        keys: Patterns for keys with the name of an argument of this function, as `priority`.
        priority: The highest is tried first.
        called: Name in messages; default: the function's.
        patterns: By key: a pattern (see `patterns`), or a value to be equal to.
    """

    def add(solve: Callable[..., Any]) -> Callable[..., Any]:
        wanted = {plain_key(key): as_pattern(value) for key, value in {**(keys or {}), **patterns}.items()}
        for each in (kind,) if isinstance(kind, str) else kind:
            rules.add(Rule(called or solve.__name__.replace("_", " ").strip(), each, wanted, solve, priority))
        return solve

    return add


def _several(solved: Any) -> Iterable[Any]:
    if solved is None:
        return ()
    return solved if isinstance(solved, (list, tuple, Iterator)) else (solved,)


def _no_match(desig: Designator, misses: list[tuple[Rule, str]]) -> str:
    if not misses:
        return f"no rules for {desig.kind}s: import process_modules.action_rules, which has those of a NAO"
    near = sorted(misses, key=lambda miss: -miss[0].keys_that_fit(desig))[:MOST_SHOWN]
    nearest = "; ".join(f"rule {rule.name!r}: {miss}" for rule, miss in near)
    more = f" ({len(misses) - len(near)} more)" if len(misses) > len(near) else ""
    return f"no rule fits: {nearest}{more}"
