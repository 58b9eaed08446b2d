"""What commands print: text for people, JSON for programs. Messages become plain values first."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import click

SAID, BEGUN = f"{__name__}.said", f"{__name__}.begun"
"""Places in `meta` of the context, which all commands of a run share: true when the JSON document is printed, and when
any JSON is, be it a document or a line."""
LEFT_OUT = frozenset({"memList", "results", "steps", "header", "onsets", "ends", "volume"})
"""Fields of results that answers or the progress tell better, or that say nothing to people."""


def plain(value: Any) -> Any:
    """A message as dicts, lists, numbers and texts; times in s."""
    to_sec = getattr(value, "to_sec", None)
    if to_sec is not None:
        return to_sec()
    slots = getattr(value, "__slots__", None)
    if slots is not None and hasattr(value, "_type"):
        return {name: plain(getattr(value, name)) for name in slots}
    if isinstance(value, Mapping):
        return {str(name): plain(entry) for name, entry in value.items()}
    if isinstance(value, (bytes, bytearray)):
        return list(value)
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return value if isinstance(value, (bool, int, float, str)) or value is None else str(value)


def say_json(value: Any, compact: bool = False) -> None:
    """Print a value as JSON: a document over several lines, or one line of many."""
    context = click.get_current_context(silent=True)
    if context is not None:
        context.meta[BEGUN] = True
        if not compact:
            context.meta[SAID] = True
    click.echo(json.dumps(_finite(plain(value)), ensure_ascii=False, indent=None if compact else 2))


def _finite(value: Any) -> Any:
    """A plain value with None for the numbers that JSON does not have."""
    if isinstance(value, dict):
        return {name: _finite(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [_finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def words(value: Any) -> str:
    """A value for people, in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        # Times of ROS are seconds since 1970: six digits of them would be days.
        return f"{value:.3f}" if 1e6 <= abs(value) < 1e15 else f"{value:.6g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {words(entry)}" for name, entry in value.items() if filled(entry))
    if isinstance(value, (list, tuple)):
        return ", ".join(map(words, value))
    return "" if value is None else str(value)


def filled(value: Any) -> bool:
    """Whether a field of a message has something to tell."""
    if isinstance(value, Mapping):
        return any(map(filled, value.values()))
    return not (value is None or value == "" or value == [] or value is False)


def say_result(result: Mapping[str, Any], end: str = "", failed: bool = False) -> None:
    """Print what a goal answered: each function's values, then the fields that the result has of its own.

    Args:
        end: What is told at the end, of a success here, of a failure in any case: an error in it is not told twice.
        failed: Of its own fields only the lists are told, what was made and found until then: the rest is state. Where
            no function was done, nothing was.
    """
    told = result.get("results", [])
    several = len(told) > 1
    for answer in told:
        error, text = answer.get("error", ""), "\n".join(answer["values"])
        if error:
            if error not in end:
                click.echo(f"{answer['function']}: {error}", err=True)
        elif several and text:
            click.echo(f"{answer['function']}: {', '.join(answer['values'])}")
        elif text:
            click.echo(text)
    for step in result.get("steps", []):
        values = [value for answer in step["results"] for value in answer["values"]]
        if values:
            click.echo(f"{step['path']} {step['what']}: {', '.join(values)}")
    own = {name: value for name, value in result.items() if name not in LEFT_OUT and filled(value)}
    if failed:
        done = any(not answer.get("error") for answer in told)
        own = {name: value for name, value in own.items() if isinstance(value, list) and done}
    say_lines(_own_lines(own))
    if end and not failed:
        click.echo(end)


def say_lines(lines: Iterable[str]) -> None:
    for line in lines:
        click.echo(line)


def _own_lines(fields: Mapping[str, Any]) -> Sequence[str]:
    """Fields of a result, lists of equal length beside each other."""
    lists = {n: v for n, v in fields.items() if isinstance(v, list) and not any(isinstance(e, Mapping) for e in v)}
    lengths = {len(value) for value in lists.values()}
    lines: list[str] = []
    if len(lists) > 1 and len(lengths) == 1:
        columns = [[words(entry) for entry in value] for value in lists.values()]
        lines += table(list(zip(*columns)))
    else:
        lines += [f"{name}: {words(value)}" for name, value in lists.items()]
    for name, value in fields.items():
        if name in lists:
            continue
        if isinstance(value, list):
            lines += [f"{name}: {words(entry)}" for entry in value]
        else:
            lines.append(f"{name}: {words(value)}")
    return lines


def table(rows: Sequence[Sequence[str]], indent: str = "") -> list[str]:
    """Rows with their columns beneath each other; the last column is as wide as it is."""
    if not rows:
        return []
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]) - 1)]
    return [
        (indent + "  ".join([*(cell.ljust(width) for cell, width in zip(row, widths)), row[-1]])).rstrip()
        for row in rows
    ]
