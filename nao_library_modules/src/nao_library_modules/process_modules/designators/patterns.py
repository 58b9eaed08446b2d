"""Patterns that the values of a designator's keys are matched with."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from numbers import Real
from typing import Any

from ...base.limits import limit
from ..language.failures import PlanError
from .designator import Designator

SETTING = limit("setting")


class Mismatch(Exception):  # caught by the matcher
    """A value does not match a pattern; the text names what would."""


@dataclass(frozen=True)
class Pattern:
    """A pattern for a value."""

    wanted: str
    take: Callable[[Any], Any]  # converts the value to what the rule receives; raises Mismatch
    default: Any = ...  # for an absent key; a key without a default is required
    exact: int = 1  # specificity: more specific rules are tried first

    def or_else(self, default: Any) -> Pattern:
        """The same pattern, for an optional key."""
        return Pattern(f"{self.wanted}, or nothing for {default!r}", self.take, default, self.exact)


def taken(pattern: Pattern, value: Any) -> Any:
    """What a pattern makes of a value outside of rules. Raises PlanError if it does not match."""
    try:
        return pattern.take(value)
    except Mismatch:
        raise PlanError(f"{value!r} is not {pattern.wanted}") from None


def anything() -> Pattern:
    return Pattern("anything", lambda value: value, exact=0)


def text() -> Pattern:

    def take(value: Any) -> str:
        if not isinstance(value, str) or not value.strip():
            raise Mismatch
        return value

    return Pattern("a text", take)


def number(lowest: float = SETTING.lowest, highest: float = SETTING.highest, unit: str = "") -> Pattern:
    ends = "" if (lowest, highest) == SETTING[:2] else f" from {lowest:g} to {highest:g}"

    def take(value: Any) -> float:
        if not isinstance(value, Real) or isinstance(value, bool) or not lowest <= value <= highest:
            raise Mismatch
        return float(value)

    return Pattern(f"a number{ends}{' ' + unit if unit else ''}", take)


def numbers(count: int, unit: str = "") -> Pattern:
    """A tuple of that many numbers; also from a mapping of x, y and z."""

    def take(value: Any) -> tuple[float, ...]:
        if isinstance(value, Mapping):
            value = [value[axis] for axis in "xyz" if axis in value]
        try:
            listed = tuple(float(each) for each in value)
        except (TypeError, ValueError, OverflowError):
            raise Mismatch from None
        if len(listed) != count or not all(SETTING.lowest <= each <= SETTING.highest for each in listed):
            raise Mismatch
        return listed

    return Pattern(f"{count} numbers{' in ' + unit if unit else ''}", take)


def one_of(*values: Any) -> Pattern:
    """One of some values; texts match in any case, with - and _ for spaces."""

    def take(value: Any) -> Any:
        for each in values:
            if value == each or (isinstance(value, str) and isinstance(each, str) and plain(value) == plain(each)):
                return each
        raise Mismatch

    return Pattern(" or ".join(map(repr, values)), take, exact=2 if len(values) == 1 else 1)


def described(kind: str) -> Pattern:

    def take(value: Any) -> Designator:
        if not isinstance(value, Designator) or value.kind != kind:
            raise Mismatch
        return value

    return Pattern(f"a designator of a{'n' if kind[0] in 'ao' else ''} {kind}", take)


def as_pattern(value: Any) -> Pattern:
    """A pattern; a plain value matches itself."""
    return value if isinstance(value, Pattern) else one_of(value)


def plain(words: str) -> str:
    """Words as they are compared: "To_Open" and "to open" are alike."""
    return " ".join(words.replace("_", " ").replace("-", " ").lower().split())
