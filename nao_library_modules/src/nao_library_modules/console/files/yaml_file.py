"""YAML files of the console, read strictly: every problem is noted with its line."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from typing import Any, Callable

from naoqi.errors import NaoError

from ...base.errors import cut
from ...base.suggestion import did_you_mean
from ...behaviors.language.errors import BehaviorError, Problem
from ...behaviors.language.expressions import text_of
from ...behaviors.language.yaml_text import Mapping as FileMapping
from ...behaviors.language.yaml_text import line_in, line_of, load

LONGEST = 400_000
"""Characters of a text that pages and files of the console take: some 8 s of reading."""


class ConsoleFileError(NaoError):
    """A file of the console will not do. `problems`: what is wrong, in the order of the file."""

    def __init__(self, name: str, problems: Sequence[Problem]) -> None:
        super().__init__(cut(f"{name}: " + "; ".join(map(str, problems))))
        self.name = name
        self.problems = tuple(problems)


class FileReader:
    """Reads one file, and collects what is wrong with it.

    `name`: of the file, for errors.
    """

    def __init__(self, text: str, name: str) -> None:
        self.name = name
        self.problems: list[Problem] = []
        if len(text) > LONGEST:
            raise ConsoleFileError(name, [Problem("", f"the text has {len(text)} characters: at most {LONGEST}", 1)])
        try:
            self.content = load(text, name)
        except BehaviorError as error:
            raise ConsoleFileError(name, error.problems) from None

    def note(self, where: str, text: str, line: int = 0) -> None:
        self.problems.append(Problem(where, text, line))

    def finish(self) -> None:
        """Raise ConsoleFileError if anything was noted."""
        if self.problems:
            raise ConsoleFileError(self.name, sorted(self.problems, key=lambda each: each.line))

    def mapping(
        self,
        value: Any,
        where: str,
        allowed: Iterable[str],
        needed: Sequence[str] = (),
        place_of: Callable[[str], str] = lambda key: "",
    ) -> FileMapping:
        """A mapping with the keys `allowed`; what it is not is noted, and unknown keys are left out.

        `place_of`: text to append to an unknown key that belongs elsewhere, else empty.
        """
        known = list(allowed)
        if not isinstance(value, dict):
            self.note(where, f"a mapping with {', '.join(known)} is wanted, not {value!r}"[:300], line_of(value))
            return FileMapping()
        for key in value:
            if key not in known:
                hint = place_of(str(key)) or did_you_mean(str(key), known)
                self.note(
                    where, f"there is no key {key!r}{hint or ': there are ' + ', '.join(known)}", line_in(value, key)
                )
        for key in needed:
            if value.get(key) is None:
                self.note(where, f"{key} is missing", line_of(value))
        kept = FileMapping((key, entry) for key, entry in value.items() if key in known)
        kept.line, kept.lines = line_of(value), getattr(value, "lines", {})
        return kept

    def items(self, value: Any, where: str) -> list[Any]:
        """A list; None is an empty one."""
        if value is None:
            return []
        if not isinstance(value, list):
            self.note(where, f"a list is wanted, not {value!r}"[:300], line_of(value))
            return []
        return value

    def text(self, holder: Any, key: str, where: str, default: str = "") -> str:
        """A text under a key of a mapping; numbers are taken as they are written."""
        value = holder.get(key, default)
        if value is None:
            return default
        if isinstance(value, bool) or not isinstance(value, (str, int, float)):
            self.note(
                f"{where}.{key}" if where else key, f"a text is wanted, not {value!r}"[:300], line_in(holder, key)
            )
            return default
        return text_of(value)

    def number(self, holder: Any, key: str, where: str, default: float, low: float = 0.0, high: float = 1e9) -> float:
        """A number `low`..`high` under a key of a mapping."""
        value = holder.get(key, default)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
            problem = f"{value!r} is not allowed: a number {low:g}..{high:g}"[:300]
            self.note(f"{where}.{key}" if where else key, problem, line_in(holder, key))
            return default
        return float(value)

    def choice(self, holder: Any, key: str, where: str, allowed: Sequence[str], default: str) -> str:
        """One of some words under a key of a mapping."""
        value = self.text(holder, key, where, default)
        if value not in allowed:
            hint = did_you_mean(value, allowed) or f": there are {', '.join(allowed)}"
            self.note(f"{where}.{key}" if where else key, f"{value!r} is not allowed{hint}", line_in(holder, key))
            return default
        return value

    def flag(self, holder: Any, key: str, where: str, default: bool = False) -> bool:
        """True or false under a key of a mapping."""
        value = holder.get(key, default)
        if not isinstance(value, bool):
            self.note(
                f"{where}.{key}" if where else key, f"{value!r} is neither true nor false"[:300], line_in(holder, key)
            )
            return default
        return value


def revision_of(text: str) -> str:
    """What tells one text of a file from another."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]
