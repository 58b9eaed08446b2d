"""What fields of messages may hold: numbers, words, texts. Pure; every function raises BadGoal."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from typing import Any

from naoqi.errors import NaoError

from .errors import BadGoal
from .limits import Limit, limit
from .suggestion import did_you_mean

LONGEST_NAME = 255
"""Longest name of a file that file systems take, bytes."""
KEY_FRAMES = limit("key frames")
CONTROL = re.compile(r"[\x00-\x1f\x7f]")
"""Characters that no name has."""


def require_number(field: str, value: float, lowest: float, highest: float, allowed: str = "") -> float:
    """A number between two others, both included; `allowed` says in words what the field may hold."""
    if not lowest <= value <= highest:  # also for NaN
        raise BadGoal(field, value, allowed or f"{lowest:g}..{highest:g}")
    return float(value)


def require_within(field: str, value: float, limit: Limit, allowed: str = "") -> float:
    """A number within the declared bounds of its kind."""
    return require_number(field, value, limit.lowest, limit.highest, allowed or limit.text)


UNUSUAL = "unusual"
"""Key of a step, in behaviours, protocols and the wizard's file, that means a number which is not usual."""


def require_usual(field: str, value: float, limit: Limit | None) -> None:
    """A number within what is usual of its kind; 0, which often stands for something else, always is."""
    if limit is not None and value != 0.0 and not limit.lowest <= value <= limit.highest:
        allowed = f"usual is {limit.text}; with `{UNUSUAL}: true` beside it, it is allowed"
        raise BadGoal(field, value, allowed, problem=f"{value:g} is unusual")


def require_zero_or(field: str, value: float, limit: Limit, zero: str = "") -> float:
    """As `require_within`; 0 is allowed as well; `zero` says what it stands for: ": the default"."""
    if value == 0.0:
        return float(value)
    return require_number(field, value, limit.lowest, limit.highest, f"{limit.text}, or 0{zero}")


def require_each(field: str, values: Iterable[float], limit: Limit) -> list[float]:
    """Numbers within the declared bounds of their kind."""
    return [require_within(field, value, limit) for value in values]


def require_length(field: str, length: int, limit: Limit) -> None:
    """A list that is not too long; `length` is that of the field or of what it stands for."""
    if length > limit.highest:
        problem = " ".join(f"{length} {limit.unit} are too many".split())
        raise BadGoal(field, length, f"at most {limit.highest:.0f}", problem=problem)


def require_rising(
    field: str, times: Sequence[float], limit: Limit, most: Limit = KEY_FRAMES, shared: bool = False
) -> None:
    """Moments that follow each other, at least one.

    `times`: s from the start. `shared`: whether the same moments are for all of several joints.
    """
    require_length(field, len(times), most)
    lowest, highest, _ = limit
    rise = all(later > earlier for earlier, later in zip(times, times[1:]))
    if not times or not rise or not all(lowest <= time <= highest for time in times):
        allowed = f"s from the start, at least one, above 0 and rising, from {lowest:g} to {highest:g}"
        allowed += "; the same times are for all joints" if shared else ""
        raise BadGoal(field, list(times), allowed)


def number_parameter(name: str, value: Any, limit: Limit, also: float | None = None) -> float:
    """A number that is a parameter of a node, within the declared bounds of its kind.

    `also`: a further number that it may be. Raises NaoError if it is something else.
    """
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not (number and (limit.lowest <= value <= limit.highest or value == also)):
        further = "" if also is None else f", or {also:g}"
        allowed = f"{limit.lowest:g} to {limit.highest:g} {limit.unit}".strip()
        raise NaoError(f"{name} is {value!r}: {allowed}{further}")
    return float(value)


def require_count(field: str, values: Sequence[float], count: int, what: str, places: str = "") -> None:
    """So many numbers, or so many for each of several places.

    `what`: they in words, with units. `places`: what they are repeated for, in words: "step"; empty where they are not.
    """
    if not values or len(values) % count if places else len(values) != count:
        each = f" for each {places}" if places else ""
        problem = f"{count} numbers{each} are needed"
        raise BadGoal(field, list(values), f"{what}; here are {len(values)}", problem=problem)


def degrees_hint(angle: float, lower: float, upper: float) -> str:
    """Text to append where a number is no angle in rad from `lower` to `upper`, and was thought of in degrees.

    Either it is a number that people type, and would be right in degrees, or it comes from some that were typed.
    """
    turned = math.radians(angle)
    if round(angle, 2) != angle and abs(math.degrees(angle) - round(math.degrees(angle), 1)) < 1e-4:
        return f"; in degrees {math.degrees(lower):.1f} to {math.degrees(upper):.1f}"
    if abs(angle) <= math.pi or not lower <= turned <= upper:
        return ""
    return f"; {angle:g} degrees are {turned:.4f} rad"


def require_whole(field: str, value: float, lowest: int, highest: int, unit: str = "") -> int:
    """A whole number between two others, both included."""
    if not (math.isfinite(value) and value == int(value) and lowest <= value <= highest):
        raise BadGoal(field, value, f"a whole number {lowest}..{highest}{unit}")
    return int(value)


def require_known(field: str, value: str, known: Sequence[str], kind: str = "") -> str:
    """One of several words, without blanks around it; `kind` is what it names: "voice"."""
    word = value.strip()
    if word not in known:
        problem = f"{word!r} is {f'no {kind}' if kind else 'not known'}{did_you_mean(word, known)}"
        raise BadGoal(field, value, f"one of {', '.join(known)}" if known else "there is none", problem=problem)
    return word


def require_text(field: str, value: str, what: str) -> str:
    if not value.strip():
        raise BadGoal(field, value, what, problem="it is empty")
    return value.strip()
