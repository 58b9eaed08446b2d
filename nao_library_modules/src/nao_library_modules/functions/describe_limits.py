"""What the words of a refusal allow: numbers between limits, words of a list. Pure."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

_NUMBER = r"(-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)"
_BETWEEN = re.compile(rf"(?:a whole number )?{_NUMBER}(?: \([a-z]+\))? ?(?:\.\.|to) ?{_NUMBER}")
_ABOVE = re.compile(rf"(?:above|more than) {_NUMBER} to {_NUMBER}")
_UP_TO = re.compile(rf"up to {_NUMBER}\b")
_AT_LEAST = re.compile(rf"(?:{_NUMBER}(?: [a-z]+)? or more|more than {_NUMBER})")
_OR_ZERO = re.compile(r"\bor 0\b")
_WORDS = re.compile(r"\bone (?:or more )?of (?P<words>[^;]+)")


@dataclass(frozen=True)
class Allowed:
    """What a function takes in a field.

    Attributes:
        text: In the words of the refusals.
        minimum: The least number; not a number where none is told.
        maximum: The greatest one, likewise.
        choices: The words that it takes, where they are a list.
    """

    text: str = ""
    minimum: float = math.nan
    maximum: float = math.nan
    choices: tuple[str, ...] = ()


def limits(text: str) -> tuple[float, float]:
    """Least and greatest number that a text allows; not a number where it names none."""
    between = _BETWEEN.match(text) or _ABOVE.match(text)
    if between:
        low, high = float(between[1]), float(between[2])
        return (min(low, 0.0), high) if _OR_ZERO.search(text) else (low, high)
    up_to = _UP_TO.match(text)
    if up_to:
        return 0.0, float(up_to[1])
    least = _AT_LEAST.match(text)
    if least:
        return float(least[1] or least[2]), math.nan
    return math.nan, math.nan


def words(text: str) -> tuple[str, ...]:
    """The words that a text lists: `one of a, b, c`."""
    match = _WORDS.search(text)
    if match is None:
        return ()
    listed = [word.strip(" '\"") for word in match["words"].split(",")]
    return tuple(listed) if all(listed) and not any(" " in word for word in listed) else ()


def told_by(texts: Sequence[str]) -> Allowed:
    """What texts of refusals allow together."""
    minimum = maximum = math.nan
    choices: tuple[str, ...] = ()
    for text in texts:
        low, high = limits(text)
        if not math.isnan(low) and math.isnan(minimum):
            minimum, maximum = low, high
        choices = choices or words(text)
    return Allowed("; ".join(texts), minimum, maximum, choices)
