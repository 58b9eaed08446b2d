"""Values as short text, for trees of tasks and for errors."""

from __future__ import annotations

import re
from typing import Any

DIGITS = 3
SHORTENED = 8
"""How much longer a number is, at most, before its digits are left out: the rest of a long text is not looked at."""
LONG_NUMBER = re.compile(r"-?\d+\.\d{4,}(?:e-?\d+)?")


def short_repr(value: Any, longest: int = 160) -> str:
    """The repr of a value with short numbers, cut to a length."""
    return cut(short_numbers(repr(value)[: SHORTENED * longest]), longest)


def short_numbers(text: str) -> str:
    """A text with its numbers rounded to three decimals."""
    return LONG_NUMBER.sub(lambda found: f"{float(found.group()):.{DIGITS}f}".rstrip("0").rstrip("."), text)


def cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else f"{text[: longest - 1]}…"
