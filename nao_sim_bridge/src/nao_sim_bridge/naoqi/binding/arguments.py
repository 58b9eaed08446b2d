"""Checks of arguments from the wire, shared by the services: what is wrong, and what would be right."""

from __future__ import annotations

import logging
import math
from typing import Any, Collection, Mapping

from nao_sim_bridge.base.errors import BadValue, UnknownName

log = logging.getLogger("nao_sim.limits")


def number(value: Any, field: str, low: float = -math.inf, high: float = math.inf) -> float:
    """`value` as a finite number within [low, high]."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise BadValue(field, value, "a finite number")
    if not low <= value <= high:
        raise BadValue(field, value, _range(low, high))
    return float(value)


def limited(value: Any, field: str, low: float, high: float) -> float:
    """`value` as a finite number, brought to the nearer limit with a line in the log; for what robots limit as well."""
    checked = number(value, field)
    within = min(max(checked, low), high)
    if within != checked:
        log.warning("%s is %g, and taken for %g: allowed is %s", field, checked, within, _range(low, high))
    return within


def whole_number(value: Any, field: str, low: int, high: int) -> int:
    """`value` as a whole number within [low, high]."""
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise BadValue(field, value, f"a whole number, {low} to {high}")
    return value


def speed_share(value: Any, field: str) -> float:
    """`value` as a fraction of the top speed, above 0 to 1."""
    share = number(value, field, 0.0, 1.0)
    if share == 0.0:
        raise BadValue(field, value, "above 0 to 1")
    return share


def text(value: Any, field: str, longest: int) -> str:
    """`value` as a text of at most `longest` characters."""
    if not isinstance(value, str):
        raise BadValue(field, value, "a text")
    if len(value) > longest:
        raise BadValue(field, value[:40] + "...", f"{longest} characters at most")
    return value


def one_of(value: Any, field: str, allowed: Collection[Any]) -> Any:
    """`value`, if it is one of those that are allowed."""
    if value not in allowed:
        raise BadValue(field, value, f"one of {', '.join(map(str, allowed))}")
    return value


def known(name: Any, kind: str, names: Collection[str]) -> Any:
    """`name`, if it is one of `names`; else an UnknownName, which calls them by their `kind`."""
    if name not in names:
        raise UnknownName(kind, name, names)
    return name


def numbers(values: Any, field: str, low: float = -math.inf, high: float = math.inf) -> list[float]:
    """A list of finite numbers within [low, high]."""
    if not isinstance(values, (list, tuple)):
        raise BadValue(field, values, "a list of numbers")
    return [number(v, f"{field}[{i}]", low, high) for i, v in enumerate(values)]


def vector(
    values: Any, field: str, count: int, allowed: str, low: float = -math.inf, high: float = math.inf
) -> list[float]:
    """A list of `count` finite numbers within [low, high], of which errors say that `allowed` are."""
    listed = numbers(values, field, low, high)
    if len(listed) != count:
        raise BadValue(field, values, allowed)
    return listed


def per_item(value: Any, count: int, field: str, low: float = -math.inf, high: float = math.inf) -> list[float]:
    """One number for all of `count` items, or a list with one for each."""
    if not isinstance(value, (list, tuple)):
        return [number(value, field, low, high)] * count
    listed = numbers(value, field, low, high)
    if len(listed) == 1:
        return listed * count
    if len(listed) != count:
        raise BadValue(field, value, f"one number or {count}, one for each joint")
    return listed


def _range(low: float, high: float) -> str:
    if high == math.inf:
        return f"{low:g} or more"
    return f"{low:g} to {high:g}"


def lists_by_tag(value: Any, field: str) -> dict[str, list[str]]:
    """Lists of texts by tag, as clients send them; a BadValue when it is something else."""
    if not isinstance(value, Mapping) or not all(isinstance(tag, str) for tag in value):
        raise BadValue(field, value, "a map of tags to lists")
    return {tag: texts(names, f"{field}[{tag!r}]") for tag, names in value.items()}


def map_or_pairs(value: Any, field: str, allowed: str = "[[key, value], ...]") -> dict[str, Any]:
    """A map with text keys, not empty, for which clients may send pairs. `allowed` is what an error asks for."""
    try:
        found = dict(value)
    except (TypeError, ValueError):
        found = {}
    if not found or not all(isinstance(key, str) for key in found):
        raise BadValue(field, value, allowed)
    return found


def texts(value: Any, field: str) -> list[str]:
    """A list of texts."""
    if not isinstance(value, (list, tuple)) or not all(isinstance(one, str) for one in value):
        raise BadValue(field, value, "a list of texts")
    return list(value)
