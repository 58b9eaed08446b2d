"""The closest known names to a mistyped one."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def closest(name: str, known: Iterable[str], count: int = 3) -> list[str]:
    """Known names that look like `name`, the closest first.

    Upper and lower case do not matter: `setcolor` is as close to `setColor` as can be.

    Args:
        name: The name as typed.
        known: Names to choose from.
        count: How many to return at most.
    """
    by_lower: dict[str, list[str]] = {}
    for candidate in known:
        by_lower.setdefault(candidate.lower(), []).append(candidate)
    matches = difflib.get_close_matches(name.lower(), list(by_lower), n=count, cutoff=0.6)
    return [candidate for match in matches for candidate in sorted(by_lower[match])][:count]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Text to append to "unknown ...": `: did you mean 'a', 'b'?`, or nothing when no name is close."""
    matches = closest(name, known)
    if not matches:
        return ""
    return f": did you mean {', '.join(repr(match) for match in matches)}?"
