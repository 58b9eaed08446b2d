"""The closest known names to a mistyped one."""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterable

LIKENESS = 0.6
"""Names less alike than this (0..1) are no suggestion."""
TEXT, TEXT_WORDS = "str_param", ("text", "color", "colour", "posture", "pose", "param", "string", "value")
"""The field that most functions take their text, name or colour from, and what it is taken for."""


def closest(name: str, known: Iterable[str], count: int = 3) -> list[str]:
    """Known names that look like `name`, the closest first.

    Of equally close ones those come first that end in a number if the name does, and in none if it does not: `FaceLed`
    rather means `FaceLeds` than `FaceLed0`. Then the longer common beginning counts, then the length, then the order in
    `known`. Upper and lower case do not matter: `setcolor` is as close to `setColor` as can be. `name`: the name as
    typed. `known`: names to choose from. `count`: how many to return at most.
    """
    matcher = difflib.SequenceMatcher(b=name.lower())
    scored = []
    for candidate in known:
        matcher.set_seq1(candidate.lower())
        # The quick one is an upper bound and spares most of the work.
        if matcher.quick_ratio() >= LIKENESS and matcher.ratio() >= LIKENESS:
            other_kind = candidate[-1:].isdigit() != name[-1:].isdigit()
            beginning = len(os.path.commonprefix([candidate.lower(), name.lower()]))
            score = (-matcher.ratio(), other_kind, -beginning, abs(len(candidate) - len(name)))
            scored.append((score, candidate))
    scored.sort(key=lambda pair: pair[0])
    return [candidate for _, candidate in scored[:count]]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Text to append to "unknown ...": `: did you mean 'a', 'b'?`, or nothing when no name is close."""
    matches = closest(name, known)
    if not matches:
        return ""
    return f": did you mean {', '.join(repr(match) for match in matches)}?"


def of_those(name: str, known: Iterable[str]) -> str:
    """Text to append to "there is no ...": the closest names where there are some, and all that there are."""
    names = list(known)
    hint = did_you_mean(name, names)
    return f"{hint}{';' if hint else ':'} there are {', '.join(names) or 'none'}"


def field_hint(name: str, known: Iterable[str]) -> str:
    """Text to append to "there is no field ...": the fields that look like it, or the one for the argument in text."""
    names = list(known)
    if TEXT in names and name.lower() in TEXT_WORDS:
        return f": did you mean {TEXT!r}?"
    return did_you_mean(name, names)
