"""Values of the robot's memory and their types in messages. No ROS."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...base.answers import json_of, value_of_json

BOOL, INT, FLOAT, TEXT = "bool", "int", "float", "string"
INTS, FLOATS, TEXTS = "int[]", "float[]", "string[]"
KINDS = (BOOL, INT, FLOAT, TEXT, INTS, FLOATS, TEXTS)
LIST, OBJECT, NULL = "list", "object", "null"
"""What a value may be besides; a message has it as JSON in a text."""
LARGEST = 2**31
"""Whole numbers of messages are below this."""


def type_of(value: Any) -> str:
    """The type of a value: one of KINDS, or LIST, OBJECT or NULL."""
    if value is None:
        return NULL
    if isinstance(value, bool):
        return BOOL
    if isinstance(value, int):
        return INT
    if isinstance(value, float):
        return FLOAT
    if isinstance(value, str):
        return TEXT
    if isinstance(value, (list, tuple)):
        return _list_type(value)
    return OBJECT


def kind_of(value: Any) -> str:
    """The kind of message for a value: one of KINDS, TEXT for values without a message of their own."""
    kind = type_of(value)
    if kind in (INT, INTS) and not _fits_int(value):
        return TEXT
    return kind if kind in KINDS else TEXT


def converted(value: Any, kind: str) -> Any:
    """A value as a message of some kind carries it; None if it cannot.

    Numbers widen (int to float, true to 1), and any value is a text. The other way would lose something.
    """
    if kind == TEXT:
        return value if isinstance(value, str) else json_of(value)
    if kind == BOOL:
        return value if isinstance(value, bool) else None
    if kind == INT:
        return int(value) if isinstance(value, int) and _fits_int(value) else None
    if kind == FLOAT:
        return float(value) if isinstance(value, (bool, int, float)) else None
    return _converted_list(value, kind)


def parse_value(text: str) -> Any:
    """A value from JSON; a text that is no JSON is itself."""
    try:
        return value_of_json(text)
    except ValueError:
        return text


def _list_type(values: Sequence[Any]) -> str:
    kinds = {type_of(value) for value in values}
    if kinds == {INT}:
        return INTS
    if kinds and kinds <= {INT, FLOAT}:
        return FLOATS
    return TEXTS if kinds == {TEXT} else LIST


def _converted_list(values: Any, kind: str) -> list[Any] | None:
    if not isinstance(values, (list, tuple)):
        return None
    single = {INTS: INT, FLOATS: FLOAT}.get(kind)
    if single is None:
        return list(values) if all(isinstance(value, str) for value in values) else None
    parts = [converted(value, single) for value in values]
    return None if any(part is None for part in parts) else parts


def _fits_int(value: Any) -> bool:
    return all(-LARGEST <= each < LARGEST for each in (value if isinstance(value, (list, tuple)) else (value,)))
