"""Chains of functions as they are typed: `setColor lights:=FaceLeds str_param:=red time:=2 , off lights:=FaceLeds`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import click

from ..core.errors import BadGoal, field_hint
from ..core.fields import limit
from ..core.geometry import ANGLES, DEGREES, in_rad

NEXT = (",", "--then")
"""What stands between two functions."""
ASSIGN = ":="
LONGEST_TIME = 2.0**31
"""s; every time in a message is shorter."""
_TRUE = {"true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}


@dataclass(frozen=True)
class TypedFunction:
    """A function and its fields as they were typed."""

    name: str
    fields: Mapping[str, str]


def read_chain(words: Iterable[str]) -> list[TypedFunction]:
    """Functions in what was typed. Raises click.UsageError if it is no chain."""
    pieces: list[list[str]] = [[]]
    for word in words:
        if word in NEXT:
            pieces.append([])
            continue
        ends = ends_function(word)
        pieces[-1].append(word[:-1] if ends else word)
        if ends:
            pieces.append([])
    chain = []
    for number, piece in enumerate(pieces, start=1):
        if not piece or ASSIGN in piece[0]:
            raise click.UsageError(f"function {number} has no name: FUNCTION field:=value ... , FUNCTION ...")
        fields: dict[str, str] = {}
        for word in piece[1:]:
            field, assigned, value = word.partition(ASSIGN)
            if not assigned or not field:
                hint = ": a comma between functions stands by itself" if _after_comma(piece, word) else ""
                if not hint and "=" in word:
                    hint = f": did you mean {word.replace('=', ASSIGN, 1)}?"
                raise click.UsageError(f"{piece[0]}: {word!r} is no field:=value{hint}")
            if field in fields:
                raise click.UsageError(f"{piece[0]}: {field} is there twice")
            fields[field] = value
        chain.append(TypedFunction(piece[0], fields))
    return chain


def ends_function(word: str) -> bool:
    """Whether a word's last comma ends a function, as in "setColor, off": in a value it may belong to the value."""
    return word.endswith(NEXT[0]) and ASSIGN not in word


def _after_comma(piece: Sequence[str], word: str) -> bool:
    """Whether a comma at the end of a value comes before a word: it was meant to end the function."""
    return piece[piece.index(word) - 1].endswith(NEXT[0])


def build_message(function: TypedFunction, kind: Any, taken: Sequence[str] = ()) -> Any:
    """The function message of a typed function.

    `taken`: fields that the function reads, where that is known: errors name these. Raises click.UsageError if a field
    is not there, or its value is none of its type.
    """
    types = dict(zip(kind.__slots__, kind._slot_types))
    message = kind(function=function.name)
    for field, text in function.fields.items():
        if field not in types or field == "function":
            known = taken or [name for name in types if name != "function"]
            told = f"{field_hint(field, known)}; there are {', '.join(known)}"
            raise click.UsageError(f"{function.name}: there is no field {field!r}{told}")
        try:
            if field not in ANGLES and types[field].startswith("float") and DEGREES in text:
                raise ValueError(f"{text!r} is an angle, and this field is none")
            setattr(message, field, read_value(types[field], text))
        except (ValueError, TypeError) as error:
            raise click.UsageError(f"{function.name}: {field}: {error}") from None
    return message


def read_value(kind: str, text: str) -> Any:
    """A value of a type as messages write it.

    Lists are values with commas between them, or YAML in brackets; messages are YAML in braces. Raises ValueError if
    the text is none.
    """
    base, bracket, _ = kind.partition("[")
    if bracket:
        return [_single(base, entry) for entry in _entries(text)]
    return _single(base, text)


def _entries(text: str) -> Sequence[Any]:
    bare = text.strip()
    if bare.startswith("["):
        value = _yaml(bare)
        if not isinstance(value, list):
            raise ValueError(f"{text!r} is no list")
        return value
    return [entry.strip() for entry in bare.split(",")] if bare else []


def _single(kind: str, value: Any) -> Any:
    reader = _READERS.get(kind)
    if reader is not None:
        return reader(value)
    if kind.startswith(("int", "uint")):
        return _whole(value)
    if kind.startswith("float"):
        return in_rad(value)
    return _message(kind, value)


class Angle(click.ParamType):
    """An angle in rad, or in degrees with `deg` behind the number; rad."""

    name = "angle"

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> float:
        try:
            return in_rad(value)
        except ValueError as error:
            self.fail(f"{error}: rad, or degrees as 90deg", parameter, context)


class Number(click.types.FloatParamType):
    """A number within the declared bounds of its kind, see `limits`."""

    def __init__(self, kind: str) -> None:
        self._limit = limit(kind)

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> float:
        number = super().convert(value, parameter, context)
        lowest, highest, unit = self._limit
        if not lowest <= number <= highest:
            self.fail(f"{number:g} is not allowed: {lowest:g} to {highest:g} {unit}".strip(), parameter, context)
        return number


def _whole(value: Any) -> int:
    try:
        whole = int(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{value!r} is no whole number") from None
    if isinstance(value, float) and whole != value:
        raise ValueError(f"{value!r} is no whole number")
    return whole


def _truth(value: Any) -> bool:
    if isinstance(value, bool):
        return value
    try:
        return _TRUE[str(value).strip().lower()]
    except KeyError:
        raise ValueError(f"{value!r} is neither true nor false") from None


def _duration(value: Any) -> Any:
    import rospy

    seconds = in_rad(value)
    if not abs(seconds) < LONGEST_TIME:
        raise ValueError(f"{value!r} is no time: at most {LONGEST_TIME:g} s")
    return rospy.Duration.from_sec(seconds)


_READERS: dict[str, Callable[[Any], Any]] = {
    "string": str,
    "bool": _truth,
    "duration": _duration,
}


def _message(kind: str, value: Any) -> Any:
    import roslib.message

    from ..behaviors.server_functions import message_of

    fields = _yaml(value) if isinstance(value, str) else value
    if not isinstance(fields, dict):
        raise ValueError(f"{value!r} is no {kind}: its fields in braces are wanted, as YAML")
    try:
        return message_of(roslib.message.get_message_class(kind), fields)
    except BadGoal as error:
        raise ValueError(str(error)) from None


def _yaml(text: str) -> Any:
    import yaml

    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(f"{text!r} is no YAML: {error}") from None
