"""Values as people want to read them in trees of tasks and in errors."""

from __future__ import annotations

import re
from typing import Any

DIGITS = 3
SHORTENED = 8
"""How much longer a number is, at most, before its digits are left out: the rest of a long text is not looked at."""
LONG_NUMBER = re.compile(r"-?\d+\.\d{4,}(?:e-?\d+)?")


def told(value: Any, longest: int = 160) -> str:
    """A value as Python prints it, with short numbers, cut when it is long."""
    return cut(short_numbers(repr(value)[: SHORTENED * longest]), longest)


def short_numbers(text: str) -> str:
    """A text whose numbers have three digits behind the point at most."""
    return LONG_NUMBER.sub(lambda found: f"{float(found.group()):.{DIGITS}f}".rstrip("0").rstrip("."), text)


def cut(text: str, longest: int) -> str:
    """A text that is not longer."""
    return text if len(text) <= longest else f"{text[: longest - 1]}…"
