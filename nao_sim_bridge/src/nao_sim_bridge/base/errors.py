"""Errors of the simulation core.

SimulationError (RuntimeError)
├── ConfigError        a data file that does not hold what it should
├── UnknownName        a joint, LED, key... that the robot does not have
├── BadValue           an argument outside what is allowed
├── NotAllowed         something that a switch forbids
├── MoveRefused        a walk that cannot begin
│   └── MovePrevented  by soft legs or an obstacle, of which robots answer nothing
├── TaskKilled         a task ended before its time
├── NotFinite          numbers for the physics engine, or of it, that are not finite
└── SimulationStopped  the simulation thread ended while somebody waited for it
"""

from __future__ import annotations

import math
import os
from typing import Any, Iterable, Sequence

LONGEST = 300
"""Characters of a value that an error shows."""
LONGEST_HINTED, MOST_HINTED = 100, 2000
"""Names that are looked at for one that is close: their characters, and how many; to compare two takes some 50 us."""


def shortened(value: Any) -> str:
    """A value as error texts show it: what a client sends may have megabytes."""
    shown = repr(value)
    return shown if len(shown) <= LONGEST else f"{shown[:LONGEST]}... ({len(shown)} characters)"


def closest(name: Any, known: Iterable[str]) -> list[str]:
    """Up to three known names that look like one, the best first; upper and lower case do not matter."""
    wanted = str(name).lower()
    lowered: dict[str, list[str]] = {}
    if len(wanted) > LONGEST_HINTED:
        return []
    for candidate in known:
        if len(candidate) <= LONGEST_HINTED:
            lowered.setdefault(candidate.lower(), []).append(candidate)
    if len(lowered) > MOST_HINTED:  # those that begin alike are the closest, mostly
        begin = os.path.commonprefix
        likely = sorted(lowered, key=lambda one: -len(begin((one, wanted))))[:MOST_HINTED]
        lowered = {one: lowered[one] for one in likely}
    import difflib  # most names are right

    close = difflib.get_close_matches(wanted, lowered, n=3, cutoff=0.5)
    return [candidate for key in close for candidate in lowered[key]][:3]


def did_you_mean(name: Any, known: Iterable[str]) -> str:
    """Text to append to "unknown ...": the closest names; nothing when none is close."""
    close = closest(name, known)
    return f": did you mean {' or '.join(map(repr, close))}?" if close else ""


class SimulationError(RuntimeError):
    """Root of everything the simulation core raises on purpose."""


class ConfigError(SimulationError):
    """A data file that does not hold what it should: `where` in which file, and the `problem` there."""

    def __init__(self, where: str, problem: str) -> None:
        self.where = where
        self.problem = problem
        super().__init__(f"{where}: {problem}")


class UnknownName(SimulationError):
    """A name that the simulated robot does not have.

    Attributes:
        kind: What was looked for, for example "joint".
        name: The name as given.
        close: The closest names there are, best first.

    Args:
        listed: Words before all names that there are, where these are few enough to be told; empty: only close ones.
    """

    def __init__(self, kind: str, name: Any, known: Iterable[str], listed: str = "") -> None:
        self.kind = kind
        self.name = name
        known = list(known)
        self.close = closest(name, known)
        there = f" ({listed}: {', '.join(known) or 'none'})" if listed else ""
        super().__init__(f"unknown {kind} {shortened(name)}{did_you_mean(name, known)}{there}")


class BadValue(SimulationError):
    """An argument outside what is allowed.

    Attributes:
        field: Name of the argument.
        value: The value as given.
        allowed: What would have been right, in words.
        known: The names that would have been right, where they are a list: the text has those that come close.
    """

    def __init__(self, field: str, value: Any, allowed: str, known: Iterable[str] = ()) -> None:
        self.field = field
        self.value = value
        self.allowed = allowed
        hint = did_you_mean(value, known)
        super().__init__(f"{field} is {shortened(value)}{hint}{'' if hint else ','} allowed is {allowed}")


class NotAllowed(SimulationError):
    """Something that a switch forbids; the text says which one allows it."""


class MoveRefused(SimulationError):
    """A walk that cannot begin; the text says why."""


class MovePrevented(MoveRefused):
    """A walk that cannot begin because of soft legs or an obstacle; a call of a robot answers nothing of it."""


class TaskKilled(SimulationError):
    """A task ended before its time because somebody killed it."""


class SimulationStopped(SimulationError):
    """The simulation thread ended while somebody waited for it."""


class NotFinite(SimulationError):
    """Numbers of which one is not finite, or that are too large to be summed up, and what they are."""

    def __init__(self, what: str, numbers: Sequence[float]) -> None:
        self.what = what
        self.numbers = tuple(numbers)
        places = [i for i, number in enumerate(self.numbers) if not math.isfinite(number)]
        shown = ", ".join(f"{self.numbers[i]} at {i}" for i in places[:5]) or "too large"
        super().__init__(f"{what}: numbers must be finite, found {shown}")


def check_finite(what: str, numbers: Iterable[float]) -> None:
    """The gate to the physics engine: refuse numbers that are about to go there, or come from it, if one is not finite.

    Raises:
        NotFinite: One of them is infinite or not a number.
    """
    if not math.isfinite(sum(numbers)):  # a tenth of the time of a look at each
        raise NotFinite(what, list(numbers))
