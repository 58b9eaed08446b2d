"""Steps of a behaviour in the values of its file: where each stands, and what of it can be changed by hand. Pure."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ...base.errors import BadGoal
from ...behaviors.language.step_reader import KINDS
from ...behaviors.language.times import at_of
from .yaml_places import EditRefused, Place, value_at

GROUPS = ("parallel", "race", "timeline", "do")
"""Keys with lists of steps."""
DIGITS = 3
"""Decimal places of times that are dragged: ms."""
_ROUND = re.compile(r"#\d+")
_NUMBER = re.compile(r"\d+")


def step_path(path: str) -> str:
    """The step of the file that a path of a run is about: of a round its repetition's, of a box the box."""
    return _ROUND.sub("", path.partition("/")[0])


def place_of(content: Any, path: str) -> Place:
    """Where a step stands. `content`: values of the file. Raises EditRefused if there is none of that path."""
    place: Place = ("do",)
    numbers = [int(number) - 1 for number in _NUMBER.findall(path)]
    if not numbers:
        raise EditRefused(f"{path!r} is no path of a step, as 2.1")
    for depth, number in enumerate(numbers):
        if depth:
            key = group_of(value_at(content, place))
            place = (*place, key) if key else place
        place = (*place, number)
    value_at(content, place)
    return place


def group_of(step: Any) -> str | None:
    """The key of a step with the steps inside of it; empty for a list of steps, None for a step without any inside."""
    if isinstance(step, list):
        return ""
    found = [key for key in GROUPS if isinstance(step, dict) and key in step]
    return found[0] if found else None


def kind_of_step(step: Any) -> str:
    """What says what a step does: one of the keys of behaviours, or SERVER.FUNCTION; empty for what is no step."""
    if isinstance(step, list):
        return "do"
    if not isinstance(step, dict):
        return ""
    kinds = [key for key in step if isinstance(key, str) and (key in KINDS or "." in key)]
    return "repeat" if "repeat" in kinds else kinds[0] if kinds else ""


def functions_in(step: Any) -> list[tuple[str, str, Mapping[str, Any], Place]]:
    """Server, function, fields and their place in the step, for each function that a step calls."""
    kind = kind_of_step(step)
    if "." in kind:
        server, _, function = kind.partition(".")
        return [(server, function, step[kind] or {}, (kind,))]
    if kind == "chain" and isinstance(step["chain"], dict):
        return [
            (server, str(each.get("function", "")), each, ("chain", server, number))
            for server, functions in step["chain"].items()
            for number, each in enumerate(functions or [])
            if isinstance(each, dict)
        ]
    return []


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def shifted(at: Any, seconds: float) -> Any:
    """A value of `at` that is later by so many s, never before what it counts from.

    Raises EditRefused if its time is calculated.
    """
    try:
        time = at_of(at)
    except BadGoal as error:
        raise EditRefused(str(error)) from None
    if not is_number(time.offset):
        raise EditRefused(f"its time is calculated, {time.offset}: edit the field at")
    offset = round(max(time.offset + seconds, 0.0), DIGITS)
    if not time.label:
        return offset
    name = f"{time.label}.end" if time.of_end else time.label
    return f"{name} + {offset:g}" if offset else name


def can_shift(step: Any) -> bool:
    """Whether the time of an entry of a timeline can be dragged."""
    try:
        shifted(step.get("at", 0.0), 0.0)
    except (EditRefused, AttributeError):
        return False
    return True


def stretches(step: Any) -> Iterator[tuple[Place, Callable[[float, float], Any]]]:
    """Fields that make a step longer: their place in it, and from its former and its new length to their new value."""
    if not isinstance(step, dict):
        return
    if is_number(step.get("wait")):
        yield ("wait",), lambda _, new: round(new, DIGITS)
        return
    functions = functions_in(step)
    if len(functions) == 1:
        _, _, fields, place = functions[0]
        times = fields.get("times")
        if is_number(fields.get("duration")) and fields["duration"] > 0.0:
            rest = fields["time"] if is_number(fields.get("time")) else 0.0
            yield (*place, "duration"), lambda _, new: round(max(new - rest, 0.05), DIGITS)
            return
        if isinstance(times, list) and times and all(map(is_number, times)):
            yield (*place, "times"), lambda old, new: [round(each * new / old, DIGITS) for each in times]
            return
        if is_number(fields.get("time")) and fields["time"] > 0.0:
            time = fields["time"]
            yield (*place, "time"), lambda old, new: round(max(time + new - old, 0.0), DIGITS)
            return
    if is_number(step.get("for")):
        yield ("for",), lambda _, new: round(new, DIGITS)


def can_stretch(step: Any) -> bool:
    return next(stretches(step), None) is not None
