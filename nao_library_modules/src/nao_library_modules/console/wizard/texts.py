"""Names in braces in texts: "Hello {participant}". Pure."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_BRACES = re.compile(r"(?<![${])\{([A-Za-z_][A-Za-z0-9_]*)\}")


def names_in(value: Any) -> tuple[str, ...]:
    """Names in braces in all texts of a value, each once, in their order. `value`: of JSON's kinds."""
    found: dict[str, None] = {}
    _collect(value, found)
    return tuple(found)


def filled_text(text: str, values: Mapping[str, str]) -> str:
    """A text with names replaced by their values; a name without a value stays."""
    return _BRACES.sub(lambda match: values.get(match[1], match[0]), text)


def _collect(value: Any, found: dict[str, None]) -> None:
    if isinstance(value, str):
        found.update(dict.fromkeys(match[1] for match in _BRACES.finditer(value)))
    elif isinstance(value, Mapping):
        for each in value.values():
            _collect(each, found)
    elif isinstance(value, (list, tuple)):
        for each in value:
            _collect(each, found)
