"""What functions answer, as the strings that a result message carries."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

_SCALARS = (bool, int, float)
LONGEST_NUMBER = 40
"""Digits of a whole number; the robot knows those of 10."""


@dataclass(frozen=True)
class Outcome:
    """A function of a chain that was done, or failed.

    Attributes:
        position: Place in the chain, counted from 1.
        function: Its name.
        values: Its answers as strings.
        elapsed: s it took, without the wait after it.
        error: Why it failed; empty if it did not.
        began: ROS time of its begin, s.
        happened: ROS times, s, at which what it waited for or did in the world began and ended; 0: not known.
    """

    position: int
    function: str
    values: list[str]
    elapsed: float
    error: str = ""
    began: float = 0.0
    happened: tuple[float, float] = (0.0, 0.0)


def text_of(value: Any) -> str:
    """One value as a string: text as it is, scalars as Python prints them, anything else as JSON."""
    if isinstance(value, str):
        return value
    if value is None or isinstance(value, _SCALARS):
        return str(value)
    return json_of(value)


def json_of(value: Any) -> str:
    """A value as JSON.

    What JSON does not know becomes its text (bytes, objects), or null (numbers that are none, or infinite).
    """
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except ValueError:  # Python would write NaN and Infinity, which other languages do not read
        return json.dumps(json.loads(json.dumps(value, default=_plain), parse_constant=lambda _: None))


def value_of_json(text: str) -> Any:
    """The value of a text.

    Raises ValueError if it is no JSON, is nested too deep, or has a whole number that no robot knows.
    """
    try:
        return json.loads(text, parse_int=_whole)
    except RecursionError:
        raise ValueError("it is nested too deep") from None


def _whole(digits: str) -> int:
    if len(digits) > LONGEST_NUMBER:
        raise ValueError(f"a whole number has {len(digits)} digits")
    return int(digits)


def _plain(value: Any) -> Any:
    if isinstance(value, (bytes, bytearray)):
        return value.hex()
    to_list = getattr(value, "tolist", None)  # arrays and scalars of numpy
    return str(value) if to_list is None else to_list()


def values_of(answer: Any) -> list[str]:
    """The answer of a function as a list of strings: nothing for None, one string a member of a list.

    A function that answers one value which is itself a list returns it inside a list: `[[1, 2]]`.
    """
    if answer is None:
        return []
    if isinstance(answer, (list, tuple)):
        return [text_of(value) for value in answer]
    return [text_of(answer)]
