"""What fields of messages may hold: numbers, words, texts. Pure; every function raises BadGoal."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from .errors import BadGoal
from .suggestion import did_you_mean

LONGEST_NAME = 255
"""Longest name of a file that file systems take, bytes."""
CONTROL = re.compile(r"[\x00-\x1f\x7f]")
"""Characters that no name has."""


def require_number(field: str, value: float, lowest: float, highest: float, allowed: str = "") -> float:
    """A number between two others, both included.

    Args:
        field: Name of the field.
        value: What it holds.
        lowest: The least it may hold.
        highest: The most it may hold.
        allowed: What it may hold, in words; the two numbers if none are given.
    """
    if not lowest <= value <= highest:  # also for NaN
        raise BadGoal(field, value, allowed or f"{lowest:g}..{highest:g}")
    return float(value)


def require_whole(field: str, value: float, lowest: int, highest: int, unit: str = "") -> int:
    """A whole number between two others, both included."""
    if not (math.isfinite(value) and value == int(value) and lowest <= value <= highest):
        raise BadGoal(field, value, f"a whole number {lowest}..{highest}{unit}")
    return int(value)


def require_known(field: str, value: str, known: Sequence[str], kind: str = "") -> str:
    """One of several words, without blanks around it.

    Args:
        field: Name of the field.
        value: What it holds.
        known: What it may hold.
        kind: What it names, in words: "voice".
    """
    word = value.strip()
    if word not in known:
        problem = f"{word!r} is {f'no {kind}' if kind else 'not known'}{did_you_mean(word, known)}"
        raise BadGoal(field, value, f"one of {', '.join(known)}" if known else "there is none", problem=problem)
    return word


def require_text(field: str, value: str, what: str) -> str:
    """Text with something in it."""
    if not value.strip():
        raise BadGoal(field, value, what, problem="it is empty")
    return value.strip()
