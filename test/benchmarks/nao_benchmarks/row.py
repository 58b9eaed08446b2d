"""One line of the table: what is measured, against what, and what is promised."""

from __future__ import annotations

import abc
from dataclasses import dataclass, field
from typing import Mapping

from .stack import Stack
from .stats import Sample


@dataclass(frozen=True)
class Bound:
    """What is promised of a figure.

    Attributes:
        kind: Which side of the limit is right, "at most" or "at least"; the limit itself is.
        limit: In the unit of the figure.
    """

    kind: str
    limit: float

    def holds(self, value: float) -> bool:
        """Whether a figure is on the right side; one that is no number never is."""
        return value <= self.limit if self.kind == "at most" else value >= self.limit

    def __str__(self) -> str:
        return f"{self.kind} {self.limit:g}"


def at_most(limit: float) -> Bound:
    """A bound from above."""
    return Bound("at most", limit)


def at_least(limit: float) -> Bound:
    """A bound from below."""
    return Bound("at least", limit)


@dataclass(frozen=True)
class Figures:
    """What a row measured.

    Attributes:
        ours: Our figure, in the unit of the row.
        reference: What it is compared with, in the same unit; None where the figure stands for itself.
        details: Further figures for the file, by name.
        note: What a reader of the table should know besides; a line at most.
    """

    ours: float
    reference: float | None = None
    details: Mapping[str, float] = field(default_factory=dict)
    note: str = ""

    @property
    def ratio(self) -> float | None:
        """Ours by reference."""
        return None if self.reference is None else self.ours / self.reference

    @property
    def value(self) -> float:
        """What the bound is about: the ratio if there is one, else our figure."""
        return self.ours if self.ratio is None else self.ratio

    @classmethod
    def compared(cls, ours: Sample, reference: Sample, scale: float, note: str = "") -> Figures:
        """Medians of two samples, with their quartiles as details.

        Args:
            ours: Our runs.
            reference: Runs of the reference.
            scale: How many of the row's units make a second.
            note: See the attribute.
        """
        details: dict[str, float] = {"runs": len(ours.seconds), "reference runs": len(reference.seconds)}
        for name, sample in (("ours", ours), ("reference", reference)):
            for which, value in zip(("first", "third"), sample.quartiles):
                details[f"{name}, {which} quartile"] = value * scale
        return cls(ours.median * scale, reference.median * scale, details, note)


class Row(abc.ABC):
    """A benchmark.

    Attributes:
        name: How it is called on the command line.
        subject: What is measured.
        against: The reference; empty where the figure stands for itself.
        unit: Of both figures.
        bound: What is promised of the ratio, or of the figure where there is no reference.
    """

    name: str
    subject: str
    against: str = ""
    unit: str
    bound: Bound

    @abc.abstractmethod
    def measure(self, stack: Stack) -> Figures:
        """Measure.

        Args:
            stack: Starts what the row needs when it is first asked for, and ends it after the last row.

        Raises:
            BenchmarkError: If it cannot be measured.
        """
