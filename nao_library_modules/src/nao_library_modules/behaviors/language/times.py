"""When an entry of a timeline begins: `1.5`, `eyes`, `eyes.end`, `eyes.end + 0.5`, `${pause}`. Pure."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from ...base.errors import BadGoal

LABEL = r"[A-Za-z_][A-Za-z0-9_-]*"
_REFERENCE = re.compile(rf"\s*({LABEL})(\.end)?\s*(?:\+\s*(\S.*?))?\s*")
ALLOWED = "s from the beginning of the timeline, LABEL, LABEL.end, or one of these with '+ seconds'"


@dataclass(frozen=True)
class At:
    """When an entry begins."""

    offset: Any = 0.0  # s, >= 0, from the beginning of the timeline or from the label; may hold `${}`
    label: str = ""  # entry or barrier that it depends on; empty: the beginning of the timeline
    of_end: bool = False  # whether it is the end of that entry that counts, not its beginning


def at_of(value: Any) -> At:
    """What a value of `at` means. Raises BadGoal if it means nothing."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return At(value)
    if not isinstance(value, str):
        raise BadGoal("at", value, ALLOWED)
    match = _REFERENCE.fullmatch(value)
    offset = match[3] or "0" if match else value.strip()
    try:
        seconds = offset if offset.startswith("${") else float(offset)
    except ValueError:
        raise BadGoal("at", value, ALLOWED) from None
    return At(seconds, match[1], match[2] is not None) if match else At(seconds)
