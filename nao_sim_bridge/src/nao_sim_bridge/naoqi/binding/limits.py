"""Bounds of arguments: how large a call may be, and which parameter of which method takes which kind of number."""

from __future__ import annotations

from typing import Any, Iterable, NamedTuple, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.limits import OTHER, Kind, check, declared, kind, kinds
from nao_sim_bridge.base.sizes import load_sizes


def check_sizes(arguments: Iterable[Any]) -> None:
    """Raise a BadValue, which says what is there and allowed, if the arguments of a call are too large together."""
    sizes, items = load_sizes().call, 0
    waiting: list[tuple[Any, int]] = [(arguments, 0)]
    while waiting:
        value, depth = waiting.pop()
        if isinstance(value, str):
            _within("text", len(value), "characters", sizes.text_characters)
        elif isinstance(value, (bytes, bytearray)):
            _within("buffer", len(value), "bytes", sizes.buffer_bytes)
        else:
            inner = (*value.keys(), *value.values()) if isinstance(value, dict) else value
            items += len(inner)
            _within("call", items, "items", sizes.items)
            _within("list", depth, "levels", sizes.levels)
            # Numbers, of which there may be many, are of no interest.
            sized = (str, bytes, bytearray, list, tuple, dict)
            waiting += [(each, depth + 1) for each in inner if isinstance(each, sized)]


def _within(what: str, there: int, unit: str, most: int) -> None:
    if there > most:
        raise BadValue(f"a {what} of the arguments", f"{there} {unit}", f"{most} {unit} at most")


class Row(NamedTuple):
    """A line of the table of bounds."""

    kind: str
    lowest: float
    highest: float
    unit: str  # of `lowest` and `highest`
    smallest: float  # how near to 0 it may be when it is not 0; 0 where that does not matter
    # Names of NAOqi's parameters, "Module.method parameter" where one has another kind than its name says, "field NAME"
    # of ROS services of the simulator, "world NAME" of keys of world files.
    where: tuple[str, ...]


def kind_of(module: str, method: str, parameter: str) -> Kind:
    own = declared()["methods"].get(f"{module}.{method}", {})
    return kind(own.get(parameter) or declared()["parameters"].get(parameter, OTHER))


def takes_texts(module: str, method: str, parameter: str) -> bool:
    """Whether a parameter takes texts of any content, and not only names."""
    return not _TEXTS.isdisjoint((parameter, f"{module}.{method} {parameter}"))


_TEXTS = frozenset(declared()["texts"])


def check_arguments(module: str, method: str, names: Sequence[str], values: Sequence[Any]) -> None:
    """Look at every number and every name in the arguments of a call.

    A BadValue when a number is out of the bounds of its kind, or a name, or a list of them, is too long.
    """
    for name, value in zip(names, values):
        if not isinstance(value, (str, bool)):
            check(value, name, kind_of(module, method, name))
        if not takes_texts(module, method, name):
            _check_names(name, value)


def _check_names(parameter: str, value: Any) -> None:
    sizes, count = load_sizes().call, 0
    waiting = [value]
    while waiting:
        one = waiting.pop()
        if isinstance(one, str):
            count += 1
            if len(one) > sizes.name_characters:
                raise BadValue(parameter, one, f"a name of {sizes.name_characters} characters at most")
            if count > sizes.names:
                raise BadValue(parameter, f"more than {sizes.names} names", f"{sizes.names} at most")
        elif isinstance(one, (list, tuple, dict)):
            inner = (*one.keys(), *one.values()) if isinstance(one, dict) else one
            waiting += [each for each in inner if isinstance(each, (str, list, tuple, dict))]


def table() -> list[Row]:
    """All kinds with their bounds and what is of them, in the order of the file."""
    where: dict[str, list[str]] = {name: [] for name in kinds()}
    for parameter, name in declared()["parameters"].items():
        where[name].append(parameter)
    for method, own in declared()["methods"].items():
        for parameter, name in own.items():
            where[name].append(f"{method} {parameter}")
    for section, word in (("fields", "field"), ("world", "world")):
        for key, name in declared()[section].items():
            where[name].append(f"{word} {key}")
    return [Row(k.name, k.lowest, k.highest, k.unit, k.smallest, tuple(where[k.name])) for k in kinds().values()]
