"""What came of a sweep: rows, rates with their intervals, plots."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence, Union

Value = Union[bool, int, float, str]
SEED, SECONDS, ERROR = "seed", "seconds", "error"
Z = 1.96
"""Of a confidence of 95 %."""


def read_value(text: str) -> Value:
    """A cell of a CSV file as what it was."""
    if text in ("True", "False"):
        return text == "True"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


@dataclass(frozen=True)
class Rate:
    """The mean of a result over all runs with equal parameters.

    Attributes:
        parameters: Name to value.
        runs: How many runs ended without an error.
        mean: Of truth values, the share of those that are true.
        count: Of truth values, how many are true; None of numbers.
        low: Where the true mean is with a confidence of 95 %, from here...
        high: ...to here: by Wilson for shares, by the standard error for numbers.
    """

    parameters: Mapping[str, Value]
    runs: int
    mean: float
    low: float
    high: float
    count: int | None = None


class Table:
    """All runs of a sweep.

    Attributes:
        names: Of the parameters.
        rows: A mapping for each run: seed, parameters, results, seconds, error.
    """

    def __init__(self, names: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> None:
        self.names = tuple(names)
        self.rows = list(rows)

    @property
    def results(self) -> tuple[str, ...]:
        """Names of the results that can be averaged."""
        skipped = {SEED, SECONDS, ERROR, *self.names}
        found = dict.fromkeys(
            name
            for row in self.rows
            for name, value in row.items()
            if not isinstance(value, str) and name not in skipped
        )
        return tuple(found)

    @property
    def errors(self) -> list[Mapping[str, Any]]:
        """Rows of the runs that have raised, or whose workers died again and again."""
        return [row for row in self.rows if row[ERROR]]

    def rates(self, result: str | None = None) -> list[Rate]:
        """Means of a result, by parameters, in the order of the sweep; of the first result if nobody says which."""
        result = result or self.results[0]
        groups: dict[tuple[Value, ...], list[float]] = {}
        truth = True
        for row in self.rows:
            values = groups.setdefault(tuple(row[name] for name in self.names), [])
            if not row[ERROR] and not isinstance(row.get(result, ""), str):
                truth &= isinstance(row[result], bool)
                values.append(float(row[result]))
        interval = _wilson if truth else _normal
        return [
            Rate(
                dict(zip(self.names, key)), len(values), *interval(values), count=round(sum(values)) if truth else None
            )
            for key, values in groups.items()
            if values
        ]

    def __str__(self) -> str:
        return self.text(*self.results)

    def text(self, *results: str) -> str:
        """The rates of these results, one table below the other, and what went wrong."""
        lines = []
        for result in results:
            rates = self.rates(result)
            truth = any(rate.count is not None for rate in rates)
            head = [*self.names, "runs", result, *(["rate"] if truth else []), "95 %"]
            cells = [
                [*map(str, rate.parameters.values()), str(rate.runs), *([str(rate.count)] if truth else [])]
                + [f"{rate.mean:.4g}", f"{rate.low:.4g} to {rate.high:.4g}"]
                for rate in rates
            ]
            widths = [max(len(row[i]) for row in [head, *cells]) for i in range(len(head))]
            lines += ["  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in [head, *cells]]
            lines.append("")
        if self.errors:
            first = self.errors[0]
            lines.append(f"{len(self.errors)} runs failed, the first (seed {first[SEED]}) with: {first[ERROR]}")
        return "\n".join(lines).rstrip("\n")

    def plot(self, path: str | Path, result: str | None = None) -> Path:
        """Draw the rates of a result over the parameter with most values, a line for each combination of the others.

        Args:
            path: PNG, PDF or SVG file.
            result: Name; the first one if nobody says which.

        Raises:
            ValueError: No parameter has numbers.
        """
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        result = result or self.results[0]
        rates = self.rates(result)
        numeric = [name for name in self.names if all(not isinstance(row[name], str) for row in self.rows)]
        if not numeric:
            raise ValueError("no parameter has numbers to be drawn over")
        along = max(numeric, key=lambda name: len({row[name] for row in self.rows}))
        lines: dict[str, list[Rate]] = {}
        for rate in rates:
            others = ", ".join(f"{name} {value}" for name, value in rate.parameters.items() if name != along)
            lines.setdefault(others, []).append(rate)
        figure, axes = pyplot.subplots(figsize=(6.4, 4.0))
        for label, points in lines.items():
            x = [float(point.parameters[along]) for point in points]
            axes.plot(x, [point.mean for point in points], "o-", label=label or None)
            axes.fill_between(x, [point.low for point in points], [point.high for point in points], alpha=0.2)
        axes.set_xlabel(along)
        axes.set_ylabel(result)
        axes.grid(alpha=0.3)
        if any(lines):
            axes.legend()
        figure.tight_layout()
        figure.savefig(path, dpi=120)
        pyplot.close(figure)
        return Path(path)


def _wilson(values: Sequence[float]) -> tuple[float, float, float]:
    """Share of ones, and Wilson's interval around it."""
    count, share = len(values), sum(values) / len(values)
    middle = (share + Z * Z / (2 * count)) / (1 + Z * Z / count)
    half = Z * math.sqrt(share * (1 - share) / count + Z * Z / (4 * count * count)) / (1 + Z * Z / count)
    return share, max(0.0, middle - half), min(1.0, middle + half)


def _normal(values: Sequence[float]) -> tuple[float, float, float]:
    """Mean, and where it is by its standard error; one value alone says nothing of that."""
    count, mean = len(values), sum(values) / len(values)
    if count == 1:
        return mean, -math.inf, math.inf
    half = Z * math.sqrt(sum((value - mean) ** 2 for value in values) / (count - 1) / count)
    return mean, mean - half, mean + half
