"""Values of what is swept, as they are typed: `0..2`, `0..2:0.5`, `0,1,4`, or several of these with commas between."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

import click

MOST = 10000
"""Values of one range."""
ROUNDING = 10
"""Decimal places: 0..1:0.1 has 0.3, not 0.30000000000000004."""
FORMS = "numbers with commas between, FROM..TO, or FROM..TO:STEP"


def read_values(text: str) -> list[float]:
    """The numbers of a range, both ends with it where the steps meet the second. Raises ValueError if it is none."""
    values: list[float] = []
    for part in text.split(","):
        first, dots, rest = part.partition("..")
        last, colon, step = rest.partition(":")
        start = _number(first, part)
        values += _steps(start, _number(last, part), _number(step, part) if colon else 1.0, part) if dots else [start]
    again = next((value for value, count in Counter(values).items() if count > 1), None)
    if again is not None:
        raise ValueError(f"{again:g} is there twice")
    return values


def _steps(start: float, end: float, step: float, text: str) -> list[float]:
    if not step > 0.0 or end < start:
        raise ValueError(f"{text!r} goes nowhere: FROM is the lower end, and STEP is above 0")
    count = math.floor((end - start) / step + 1e-9) + 1
    if count > MOST:
        raise ValueError(f"{text!r} are {count} values, more than {MOST}")
    return [round(start + number * step, ROUNDING) for number in range(count)]


def _number(text: str, part: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{part!r} is no range: {FORMS}")
    return number


class Values(click.ParamType):
    """Numbers that are swept; [float]."""

    name = "values"

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> list[Any]:
        if not isinstance(value, str):
            return value
        try:
            return self.read(value)
        except ValueError as error:
            self.fail(str(error), parameter, context)

    def read(self, text: str) -> list[Any]:
        return read_values(text)


class Seeds(Values):
    """So many seeds from 0 on, or which ones as a range with `..` or a comma; [int]."""

    name = "seeds"

    def read(self, text: str) -> list[Any]:
        values = list(range(int(text))) if text.isdigit() else read_values(text)
        wrong = next((seed for seed in values if seed != int(seed) or seed < 0), None)
        if wrong is not None or not values:
            told = "no seeds" if wrong is None else f"{wrong:g} is no seed"
            raise ValueError(f"{told}: how many, 1 or more, or whole numbers from 0 on as 100..199")
        return list(map(int, values))
