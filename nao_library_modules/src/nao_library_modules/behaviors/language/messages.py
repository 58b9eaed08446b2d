"""Function messages from the fields of a file, and back. By the types that genpy knows of each field."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import genpy
import roslib.message

from ...base.degrees import ANGLES, in_rad, is_in_degrees
from ...base.errors import BadGoal
from ...base.suggestion import field_hint
from .expressions import text_of

_ARRAY = re.compile(r"(?P<item>.+)\[(?P<length>\d*)\]")
_RANGES = {f"{sign}int{bits}": bits for sign in ("", "u") for bits in (8, 16, 32, 64)}
_RANGES.update(byte=8, char=8)
_FLOATS = {"float32": 3.4028235e38, "float64": math.inf}
NANOSECONDS = 1_000_000_000


def message_of(message_type: type, fields: Any, where: str = "", taken: Sequence[str] = ()) -> Any:
    """A message with some fields filled; the others have their defaults.

    Raises BadGoal if a field is unknown, or its value is of the wrong kind.

    Args:
        fields: Name -> plain value; times and durations in s.
        where: What errors put before the names of fields.
        taken: Fields that make sense here, where not all do: errors name these.
    """
    if not isinstance(fields, dict):
        raise BadGoal(where or message_type.__name__, fields, f"a mapping with {', '.join(message_type.__slots__)}")
    message = message_type()
    types = dict(zip(message_type.__slots__, message_type._slot_types))
    prefix = f"{where}." if where else ""
    for name, value in fields.items():
        if name not in types:
            known = [*taken] or [*types]
            hint = field_hint(str(name), known)
            problem = f"{message_type.__name__} has no field {name!r}{hint}"
            raise BadGoal(f"{prefix}{name}", value, f"there are {', '.join(known)}", problem=problem)
        setattr(message, name, _value(types[name], _in_rad(value) if name in ANGLES else value, f"{prefix}{name}"))
    return message


def _in_rad(value: Any) -> Any:
    """Angles in rad; what is no angle in degrees as it is."""
    if isinstance(value, list):
        return [_in_rad(each) for each in value]
    try:
        return in_rad(value) if is_in_degrees(value) else value
    except ValueError:
        return value


def fields_of(message: Any) -> dict[str, Any]:
    """Fields of a message that differ from their defaults: `message_of` makes the same message of them."""
    default = type(message)()
    return {
        name: _plain(kind, getattr(message, name))
        for name, kind in zip(message.__slots__, message._slot_types)
        if not _same(getattr(message, name), getattr(default, name))
    }


def _value(kind: str, value: Any, where: str) -> Any:
    array = _ARRAY.fullmatch(kind)
    if array:
        return _list(array["item"], array["length"], value, where)
    if kind in ("time", "duration"):
        return _time(genpy.Time if kind == "time" else genpy.Duration, value, where)
    if kind == "bool":
        if not isinstance(value, bool):
            raise BadGoal(where, value, "true or false")
        return value
    if kind == "string":
        if isinstance(value, bool) or not isinstance(value, (str, int, float)):
            raise BadGoal(where, value, "a text, in quotes", problem=f"{text_of(value)[:200]!r} is no text")
        return text_of(value)
    if kind in _RANGES:
        return _integer(kind, value, where)
    if kind in _FLOATS:
        return _float(kind, value, where)
    message_type = roslib.message.get_message_class(kind)
    if message_type is None:
        raise BadGoal(where, value, "fields whose messages are built", problem=f"the message {kind} is not known")
    return message_of(message_type, value, where)


def _list(kind: str, length: str, value: Any, where: str) -> Any:
    if not isinstance(value, list):
        example = text_of(value) if isinstance(value, (str, int, float)) else "..."
        raise BadGoal(where, value, f"a list: [{example}]")
    if length and len(value) != int(length):
        raise BadGoal(where, value, f"{length} values", problem=f"it has {len(value)} values")
    items = [_value(kind, each, f"{where}[{i}]") for i, each in enumerate(value)]
    return bytes(items) if kind in ("uint8", "char") else items


def _integer(kind: str, value: Any, where: str) -> int:
    unsigned = kind.startswith("u") or kind == "char"
    bits = _RANGES[kind]
    lowest, highest = (0, 2**bits - 1) if unsigned else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
    if isinstance(value, bool) or not whole or not lowest <= value <= highest:
        raise BadGoal(where, value, f"a whole number {lowest}..{highest}")
    return int(value)


def _float(kind: str, value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise BadGoal(where, value, "a number")
    # Integers of YAML may have any length.
    if abs(value) > 1e308 or not math.isfinite(value) or abs(value) > _FLOATS[kind]:
        raise BadGoal(where, value, "a finite number")
    return float(value)


def _time(kind: type, value: Any, where: str) -> Any:
    number = _float("float64", value, where)
    if not -(2**31) <= number < 2**31 or (kind is genpy.Time and number < 0.0):
        raise BadGoal(where, value, "s, less than 2147483648")
    # from_sec cuts digits off instead of rounding them.
    seconds, nanoseconds = divmod(round(number * NANOSECONDS), NANOSECONDS)
    return kind(seconds, nanoseconds)


def _plain(kind: str, value: Any) -> Any:
    array = _ARRAY.fullmatch(kind)
    if array:
        return [_plain(array["item"], each) for each in value]
    if kind in ("time", "duration"):
        return value.to_sec()
    if isinstance(value, genpy.Message):
        return fields_of(value)
    if kind == "bool":
        return bool(value)
    return value


def _same(a: Any, b: Any) -> bool:
    """Whether two values are equal; lists and tuples are, when what is in them is."""
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    return bool(a == b)
