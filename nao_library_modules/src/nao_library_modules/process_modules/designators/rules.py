"""Rules: what turns a description into what can be done. Data that is matched, and small functions.

    @rule(action, type="opening", gripper=one_of("left", "right"))
    def opening(gripper):
        return Command("manipulation", "open_gripper", side=gripper)

A rule fits when every key of its pattern does; keys that it does not name do not matter. Of those that fit the one with
the highest priority comes first, then the one that says most, then the one that was added last: a user's rule goes
before ours. What a rule gives are solutions, in its order; those of the next rule come after them.
"""

from __future__ import annotations

import inspect
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..language.failures import DesignatorError, PlanError
from ..language.telling import told
from .designator import KINDS, Designator, plain_key, resolve_by
from .patterns import Mismatch, Pattern, as_pattern

MOST_TOLD = 4
DESIG = "desig"


@dataclass(frozen=True)
class Command:
    """What a process module can do at once: the solution of an action or a motion.

    Attributes:
        module: Name of the process module.
        name: Of what it does, as `open_gripper`.
        arguments: Numbers and names, by name.
    """

    module: str
    name: str
    arguments: Mapping[str, Any] = field(default_factory=dict)

    def __str__(self) -> str:
        inside = ", ".join(f"{name}={told(value)}" for name, value in self.arguments.items())
        return f"{self.module}: {self.name}({inside})"


def command(module: str, name: str, /, **arguments: Any) -> Command:
    """A command with its arguments by name."""
    return Command(module, name, arguments)


@dataclass(frozen=True)
class Rule:
    """See the top of this file.

    Attributes:
        name: For people.
        kind: Of designators that it is about.
        patterns: By key.
        solve: Gets the values of those keys that its arguments are named after, and the designator as `desig`; gives a
            solution, or several of them, or None for none.
        priority: The highest goes first.

    Raises:
        PlanError: An argument is no key.
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
        """What it gives for a designator that it fits; see `match` for the values."""
        known = {**values, DESIG: desig}
        return _several(self.solve(**{name: known[name] for name in self._arguments()}))

    @property
    def exact(self) -> int:
        """How much it says."""
        return sum(pattern.exact for pattern in self.patterns.values())

    def match(self, desig: Designator) -> dict[str, Any]:
        """The values of its keys.

        Raises:
            Mismatch: It does not fit, with the key and what it wants.
        """
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
                raise Mismatch(f"{key} is {told(desig[key])}, not {pattern.wanted}") from None
        return values

    def keys_that_fit(self, desig: Designator) -> int:
        """How many keys of the pattern fit: what a rule that nearly fits is known by."""
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
    """All rules there are. Any thread may ask and add."""

    def __init__(self) -> None:
        self._rules: tuple[Rule, ...] = ()
        self._lock = threading.Lock()

    def add(self, new: Rule) -> Rule:
        """Add a rule; one of the same name and kind takes the place of the old one.

        Raises:
            PlanError: Its kind is unknown.
        """
        if new.kind not in KINDS:
            raise PlanError(f"the rule {new.name}: designators are of the kinds {', '.join(KINDS)}, not {new.kind!r}")
        with self._lock:
            others = [rule for rule in self._rules if (rule.name, rule.kind) != (new.name, new.kind)]
            self._rules = tuple(sorted([new, *others], key=lambda rule: (-rule.priority, -rule.exact)))
        return new

    def remove(self, old: Rule) -> None:
        """Take a rule away."""
        with self._lock:
            self._rules = tuple(rule for rule in self._rules if rule is not old)

    def of(self, kind: str) -> list[Rule]:
        """Rules about a kind of designators, in the order in which they are tried."""
        return [rule for rule in self._rules if rule.kind == kind]

    def solutions(self, desig: Designator) -> Iterator[Any]:
        """Solutions of all rules that fit.

        Raises:
            DesignatorError: No rule fits: those that nearly did, and the key on which each failed.
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
            raise DesignatorError(desig, _told(desig, misses))


RULES = Rules()
"""Those of this package, and what users add."""
resolve_by(RULES.solutions)


def rule(
    kind: str | tuple[str, ...],
    keys: Mapping[str, Any] | None = None,
    *,
    priority: int = 0,
    called: str = "",
    rules: Rules = RULES,
    **patterns: Any,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """A function as a rule.

    Args:
        kind: Of designators that it is about; several in a tuple.
        keys: Patterns by key, for keys that are arguments of this function, as `priority`.
        priority: The highest goes first.
        called: Its name, for people; that of the function if there is none.
        rules: Where it is added.
        **patterns: By key: a pattern (see `patterns`), or a value that has to be just that.
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


def _told(desig: Designator, misses: list[tuple[Rule, str]]) -> str:
    if not misses:
        return f"there is no rule about {desig.kind}s"
    near = sorted(misses, key=lambda miss: -miss[0].keys_that_fit(desig))[:MOST_TOLD]
    told = "; ".join(f"rule {rule.name!r}: {miss}" for rule, miss in near)
    more = f" ({len(misses) - len(near)} more)" if len(misses) > len(near) else ""
    return f"no rule fits: {told}{more}"
