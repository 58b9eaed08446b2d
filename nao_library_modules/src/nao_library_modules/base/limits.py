"""Bounds of the numbers that come in from outside, by kind, as `config/limits.json` declares them. Pure."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any, NamedTuple

from .paths import config_file

FILE = "limits.json"


class Limit(NamedTuple):
    """Bounds of one kind of number, both included; neither is infinite."""

    lowest: float
    highest: float
    unit: str

    @property
    def text(self) -> str:
        """What is allowed, in words: "0.1..60 s"."""
        return f"{self.lowest:g}..{self.highest:g} {self.unit}".strip()


def limit(kind: str) -> Limit:
    """The bounds of a kind of number."""
    declared = _declared_limits()[kind]
    return Limit(declared["lowest"], declared["highest"], declared["unit"])


def usual(kind: str) -> Limit | None:
    """The bounds of what is usual of a kind of number, which checks before a run look at; None: all that is allowed."""
    declared = _declared_limits()[kind]
    return Limit(*declared["usual"], declared["unit"]) if "usual" in declared else None


class Row(NamedTuple):
    """A line of the table of bounds: a kind of number, its bounds, where they hold, in words, and what is usual."""

    kind: str
    lowest: float
    highest: float
    unit: str
    where: str
    usual: tuple[float, float] | None = None


def table() -> list[Row]:
    """All kinds, in the order of the file."""
    return [Row(kind, **declared) for kind, declared in _declared_limits().items()]


@lru_cache(maxsize=None)
def _declared_limits() -> dict[str, dict[str, Any]]:
    content = json.loads(config_file(FILE).read_text(encoding="utf-8"))
    return {kind: declared for kind, declared in content.items() if not kind.startswith("_")}
