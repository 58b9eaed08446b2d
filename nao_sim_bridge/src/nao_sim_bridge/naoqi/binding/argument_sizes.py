"""How large the arguments of a call may be, looked at once for all calls: texts, bytes, items of lists, depth."""

from __future__ import annotations

from typing import Any, Iterable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes


def check_sizes(arguments: Iterable[Any]) -> None:
    """Raise an error if the arguments of a call are too large together.

    Raises:
        BadValue: They are; it says what there is and what is allowed.
    """
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
            kinds = (str, bytes, bytearray, list, tuple, dict)
            waiting += [(each, depth + 1) for each in inner if isinstance(each, kinds)]


def _within(what: str, there: int, unit: str, most: int) -> None:
    if there > most:
        raise BadValue(f"a {what} of the arguments", f"{there} {unit}", f"{most} {unit} at most")
