"""Whether what came over the wire is of the types that NAOqi's table has, and its numbers within their bounds.

libqi looks at the number of arguments only: it hands a list to a method whose signature says int. Which values make
sense is up to the methods, which have better words for what is wrong with them; see `limits.py` for the bounds.
"""

from __future__ import annotations

import math
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.binding.api import Method, Overload, qi_type
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.binding.limits import check_arguments

ANYTHING, INT, TEXTS = "ALValue", "int", "list<string>"
LARGEST_INT = 2**31 - 1
Test = Callable[[Any], bool]


def fitted(method: Method, arguments: Sequence[Any], module: str = "") -> list[Any]:
    """The arguments of a call as the method takes them.

    A text where it takes a list of texts is a list of this one; a whole number is an int, also where it came as 2.0 or
    as true. Of overloads that take the same number of arguments, the one counts for which least has to be changed.

    Some numbers have bounds of their own in one `module`. A NaoqiError when it takes another number of arguments; a
    BadValue when one of them is of another type, or a number in it is out of bounds.
    """
    overloads = [overload for overload in method.overloads if len(overload.types) == len(arguments)]
    if not overloads:
        ways = " or ".join(f"{method.name}({overload})" for overload in method.overloads)
        raise NaoqiError(f"was called with {len(arguments)} arguments, allowed is {ways}")
    return _fitted(module, method.name, overloads, arguments)


def fitted_to(
    names: Sequence[str], signatures: Sequence[str], values: Sequence[Any], module: str = "", method: str = ""
) -> list[Any]:
    """As `fitted`, with types in libqi's letters."""
    types = tuple(_BY_SIGNATURE.get(signature, ANYTHING) for signature in signatures)
    return _fitted(module, method, [Overload(types, tuple(names))], values)


def _fitted(module: str, method: str, overloads: Sequence[Overload], values: Sequence[Any]) -> list[Any]:
    left = list(overloads)
    for i, value in enumerate(values):
        fitting = [overload for overload in left if _fits(value, overload.types[i])]
        if not fitting:
            kinds = dict.fromkeys(overload.types[i] for overload in left)
            raise BadValue(left[0].names[i], value, " or ".join(_TYPES[kind][0] for kind in kinds))
        left = fitting
    ways = [([_as_type(*given) for given in zip(values, overload.types)], overload) for overload in left]
    way, chosen = min(ways, key=lambda found: sum(new is not old for new, old in zip(found[0], values)))
    check_arguments(module, method, chosen.names, way)
    return way


def has_bytes(value: Any) -> bool:
    """Whether bytes are somewhere in a value."""
    if isinstance(value, (bytes, bytearray)):
        return True
    if isinstance(value, dict):
        return has_bytes([*value.keys(), *value.values()])
    return isinstance(value, (list, tuple)) and any(has_bytes(each) for each in value)


def _fits(value: Any, kind: str) -> bool:
    return kind not in _TYPES or _TYPES[kind][1](value) or (kind == TEXTS and _is_text(value))


def _as_type(value: Any, kind: str) -> Any:
    """A value that fits, as what it fits."""
    if kind == INT:
        return int(value)
    return [value] if kind == TEXTS and _is_text(value) else value


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float))


def _is_bool(value: Any) -> bool:
    return _is_number(value) and math.isfinite(value)


def _is_int(value: Any) -> bool:
    return _is_number(value) and -LARGEST_INT - 1 <= value <= LARGEST_INT and float(value).is_integer()


def _list_of(test: Test) -> Test:
    return lambda value: isinstance(value, (list, tuple)) and all(map(test, value))


def _map_to(test: Test) -> Test:
    return lambda value: isinstance(value, dict) and all(_is_text(k) and test(v) for k, v in value.items())


# NAOqi's type -> what it is in words, and the test; others are handed on as they come.
_TYPES: Mapping[str, tuple[str, Test]] = {
    "string": ("a text", _is_text),
    "bool": ("true or false", _is_bool),
    INT: (f"a whole number, {-LARGEST_INT - 1} to {LARGEST_INT}", _is_int),
    "float": ("a number", _is_number),
    TEXTS: ("a list of texts", _list_of(_is_text)),
    "list<float>": ("a list of numbers", _list_of(_is_number)),
    "list<int>": ("a list of whole numbers", _list_of(_is_int)),
    "map<string,string>": ("texts by texts", _map_to(_is_text)),
    "TagForAnimations": ("lists of texts by texts", _map_to(_list_of(_is_text))),
}
_BY_SIGNATURE = {qi_type(name): name for name in _TYPES}
