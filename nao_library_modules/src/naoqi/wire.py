"""What goes over the wire and what comes back, in plain Python values.

Outwards: libqi's Python binding refuses NumPy values, and turns an unknown object into a remote one without a
word; so everything that is not plain is converted here or refused by name. Inwards: raw data become `bytes`.
Plain values pass with one look-up each, which is all that most calls ever need.
"""

from __future__ import annotations

import enum
from collections.abc import Iterator, Mapping, MappingView, Set
from typing import Any, Callable, Tuple

PLAIN = frozenset((bool, int, float, str, type(None)))
LOWEST_INTEGER, HIGHEST_INTEGER = -(2**63), 2**63 - 1
PYTHON2_LISTS = (range, Iterator, MappingView, Set)
"""`range()`, `map()`, `d.keys()` and others were lists when the SDK was current; ported scripts pass them."""
_CONTAINERS = frozenset((list, tuple, dict, bytearray))


class UnsendableError(Exception):
    """A value that libqi cannot carry; its text says which and why. Never leaves the proxy layer."""


def to_wire(arguments: Tuple[Any, ...], takes_raw: Callable[[], bool]) -> Tuple[Any, ...]:
    """Arguments of a call as libqi takes them.

    `arguments`: what the caller gave. `takes_raw`: asked only when there are bytes: does the method declare raw data?
    Returns the same tuple if all was plain, else a converted one. Raises UnsendableError if an argument cannot travel.
    """
    for argument in arguments:
        if type(argument) not in PLAIN:
            return tuple(_outwards(each, takes_raw) for each in arguments)
    return arguments


def from_wire(value: Any) -> Any:
    """A value that came from the robot, with raw data as `bytes` at every depth."""
    kind = type(value)
    if kind not in _CONTAINERS:
        return value
    if kind is bytearray:
        return bytes(value)
    if kind is dict:
        if _CONTAINERS.isdisjoint(map(type, value.values())):
            return value
        return {key: from_wire(each) for key, each in value.items()}
    if _CONTAINERS.isdisjoint(map(type, value)):
        return value
    return kind(map(from_wire, value))


def check_sendable(value: Any) -> None:
    """Look for what libqi itself refuses inside plain values; too slow for every call, so after a failure.

    Raises UnsendableError if there is an integer beyond 64 bits or a text that is no Unicode.
    """
    if isinstance(value, int) and not LOWEST_INTEGER <= value <= HIGHEST_INTEGER:
        raise UnsendableError(f"{value} does not fit into 64 bits")
    if isinstance(value, str):
        try:
            value.encode("utf-8")
        except UnicodeEncodeError:
            raise UnsendableError(f"{value!r} holds characters that are not Unicode") from None
    elif isinstance(value, dict):
        for pair in value.items():
            check_sendable(pair)
    elif isinstance(value, (list, tuple)):
        for each in value:
            check_sendable(each)


def _outwards(value: Any, takes_raw: Callable[[], bool]) -> Any:
    if type(value) in PLAIN:
        return value
    if isinstance(value, (list, tuple)):
        if PLAIN.issuperset(map(type, value)):
            return value if type(value) in _CONTAINERS else tuple(value)
        return [_outwards(each, takes_raw) for each in value]
    if isinstance(value, (bytes, bytearray, memoryview)):
        return _raw_outwards(bytes(value), takes_raw)
    if isinstance(value, enum.Enum):
        return _outwards(value.value, takes_raw)
    if hasattr(value, "tolist"):  # NumPy scalars and arrays, without importing NumPy
        return _outwards(value.tolist(), takes_raw)
    for base in (int, float, str):
        if isinstance(value, base):
            return base(value)
    if isinstance(value, Mapping):
        return {_outwards(key, takes_raw): _outwards(each, takes_raw) for key, each in value.items()}
    if isinstance(value, PYTHON2_LISTS):
        return [_outwards(each, takes_raw) for each in value]
    if callable(value) or type(value).__module__.split(".")[0] == "qi":
        return value  # functions, and objects of libqi itself, travel as remote objects
    raise UnsendableError(f"a value of type {type(value).__name__} cannot be sent: {value!r}")


def _raw_outwards(value: bytes, takes_raw: Callable[[], bool]) -> Any:
    if takes_raw():
        return value
    try:
        return value.decode("utf-8")
    except UnicodeDecodeError:
        # libqi 3.1.5 would send the text of their repr instead, and nobody would notice.
        raise UnsendableError(
            f"{len(value)} raw bytes can only be sent to a method that declares raw data, or as UTF-8 text"
        ) from None
