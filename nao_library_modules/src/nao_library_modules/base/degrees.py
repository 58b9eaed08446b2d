"""Angles that are typed in degrees: `45deg` where a number of rad is meant."""

from __future__ import annotations

import math
from typing import Any

DEGREES = "deg"
"""Behind a number in a field for angles: 45deg are 0.785 rad."""
ANGLES = frozenset({"angles", "values"})
"""Fields whose numbers are angles in rad, or may be."""


def is_in_degrees(value: Any) -> bool:
    """Whether a text is meant as an angle in degrees."""
    return isinstance(value, str) and value.strip().endswith((DEGREES, "°"))


def in_rad(value: Any) -> float:
    """A number, or an angle in degrees as rad. Raises ValueError if it is neither."""
    try:
        if is_in_degrees(value):
            return math.radians(float(value.strip().replace("°", DEGREES)[: -len(DEGREES)]))
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{value!r} is no number") from None
