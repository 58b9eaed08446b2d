"""Chains of functions as they are typed: `setColor lights:=FaceLeds str_param:=red time:=2 , off lights:=FaceLeds`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import click

from ..suggestion import did_you_mean

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
    """Functions in what was typed.

    Raises:
        click.UsageError: It is no chain.
    """
    pieces: list[list[str]] = [[]]
    for word in words:
        if word in NEXT:
            pieces.append([])
            continue
        # "setColor, off": the comma may stand at the end of a word, where it cannot be part of a value.
        ends = word.endswith(",") and ASSIGN not in word
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
                raise click.UsageError(f"{piece[0]}: {word!r} is no field:=value")
            if field in fields:
                raise click.UsageError(f"{piece[0]}: {field} is there twice")
            fields[field] = value
        chain.append(TypedFunction(piece[0], fields))
    return chain


def build_message(function: TypedFunction, kind: Any) -> Any:
    """The function message of a typed function.

    Raises:
        click.UsageError: A field is not there, or its value is none of its type.
    """
    types = dict(zip(kind.__slots__, kind._slot_types))
    message = kind(function=function.name)
    for field, text in function.fields.items():
        if field not in types or field == "function":
            known = [name for name in types if name != "function"]
            where = f"{function.name}: there is no field {field!r}{did_you_mean(field, known)}"
            raise click.UsageError(f"{where}; there are {', '.join(known)}")
        try:
            setattr(message, field, read_value(types[field], text))
        except (ValueError, TypeError) as error:
            raise click.UsageError(f"{function.name}: {field}: {error}") from None
    return message


def read_value(kind: str, text: str) -> Any:
    """A value of a type as messages write it.

    Lists are values with commas between them, or YAML in brackets; messages are YAML in braces.

    Raises:
        ValueError: The text is none.
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
        return _number(value)
    return _message(kind, value)


def _number(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{value!r} is no number") from None


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

    seconds = _number(value)
    if not abs(seconds) < LONGEST_TIME:
        raise ValueError(f"{value!r} is no time: at most {LONGEST_TIME:g} s")
    return rospy.Duration.from_sec(seconds)


_READERS: dict[str, Callable[[Any], Any]] = {
    "string": str,
    "bool": _truth,
    "duration": _duration,
}


def _message(kind: str, value: Any) -> Any:
    import genpy
    import roslib.message

    fields = _yaml(value) if isinstance(value, str) else value
    if not isinstance(fields, dict):
        raise ValueError(f"{value!r} is no {kind}: its fields in braces are wanted, as YAML")
    message = roslib.message.get_message_class(kind)()
    try:
        genpy.message.fill_message_args(message, [fields])
    except genpy.MessageException as error:
        raise ValueError(str(error)) from None
    return message


def _yaml(text: str) -> Any:
    import yaml

    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(f"{text!r} is no YAML: {error}") from None
