"""The table on the screen and the file."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

from .row import Figures, Row

HEADINGS = ("name", "ours", "reference", "ratio", "bound", "ok")
NUMERIC = (1, 2, 3)


@dataclass(frozen=True)
class Result:
    """What came of a row.

    Attributes:
        row: The row.
        figures: What it measured; None if it could not.
        error: Why not.
    """

    row: Row
    figures: Figures | None
    error: str = ""

    @property
    def ok(self) -> bool:
        """Whether it was measured and keeps its bound."""
        return self.figures is not None and self.row.bound.holds(self.figures.value)


def table(results: Sequence[Result]) -> str:
    """A table for people: one line a row, and under it what the rows are, with notes."""
    lines = [HEADINGS, *(_cells(result) for result in results)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(HEADINGS))]
    text = ["  ".join(_aligned(line, widths)).rstrip() for line in lines]
    text.insert(1, "-" * (sum(widths) + 2 * (len(widths) - 1)))
    width = max((len(result.row.name) for result in results), default=0)
    text.append("")
    for result in results:
        against = f" : {result.row.against}" if result.row.against else " (absolute)"
        text.append(f"{result.row.name:<{width}}  {result.row.subject}{against}")
        if result.figures is not None and result.figures.note:
            text.append(f"{'':<{width}}    {result.figures.note}")
    text += [f"\n{result.row.name}: not measured: {result.error}" for result in results if result.error]
    return "\n".join(text)


def _cells(result: Result) -> tuple[str, ...]:
    row, figures = result.row, result.figures
    ok = "yes" if result.ok else "NO"
    if figures is None:
        return row.name, "-", "-", "-", str(row.bound), ok
    reference = "-" if figures.reference is None else f"{figures.reference:.4g} {row.unit}"
    ratio = "-" if figures.ratio is None else f"{figures.ratio:.3f}"
    bound = f"{row.bound} {row.unit}" if figures.ratio is None else str(row.bound)
    return row.name, f"{figures.ours:.4g} {row.unit}", reference, ratio, bound, ok


def _aligned(line: Sequence[str], widths: Sequence[int]) -> list[str]:
    return [
        cell.rjust(width) if column in NUMERIC else cell.ljust(width)
        for column, (cell, width) in enumerate(zip(line, widths))
    ]


def record(results: Sequence[Result], machine: Mapping[str, object]) -> dict[str, object]:
    """The same for programs."""
    return {"machine": dict(machine), "rows": [_entry(result) for result in results]}


def _entry(result: Result) -> dict[str, object]:
    row, figures = result.row, result.figures
    return {
        "name": row.name,
        "subject": row.subject,
        "against": row.against or None,
        "unit": row.unit,
        "ours": None if figures is None else figures.ours,
        "reference": None if figures is None else figures.reference,
        "ratio": None if figures is None else figures.ratio,
        "bound": {"kind": row.bound.kind, "limit": row.bound.limit},
        "ok": result.ok,
        "error": result.error or None,
        "note": None if figures is None else figures.note or None,
        "details": {} if figures is None else dict(figures.details),
    }


def write(path: Path, content: Mapping[str, object]) -> None:
    """Write the file; its folder is made if need be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
