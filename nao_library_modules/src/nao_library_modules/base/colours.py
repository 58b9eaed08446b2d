"""Colours by name or as text, and as the integers that ALLeds takes."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Tuple

from .errors import BadGoal
from .paths import config_file
from .suggestion import did_you_mean

Colour = Tuple[float, float, float]
"""Red, green and blue, each 0..1."""

_HEX = re.compile(r"(?:#|0x)([0-9a-f]{6})")


def read_colours(path: Path) -> Mapping[str, Colour]:
    """Read a table of named colours. Raises ValueError if an entry is not three numbers within 0..1."""
    table = json.loads(path.read_text())
    table.pop("_source", None)
    for name, rgb in table.items():
        if len(rgb) != 3 or not all(0.0 <= part <= 1.0 for part in rgb):
            raise ValueError(f"{path}: {name}: {rgb} is not red, green and blue within 0..1")
    return {name: (float(red), float(green), float(blue)) for name, (red, green, blue) in table.items()}


@lru_cache(maxsize=None)
def named_colours() -> Mapping[str, Colour]:
    return read_colours(config_file("colours.json"))


ALLOWED = f"'#RRGGBB', '0xRRGGBB' or one of {', '.join(named_colours())}"
"""What a text for a colour may be."""


def parse_colour(text: str, field: str = "str_param") -> Colour:
    """A colour from its name, `#RRGGBB` or `0xRRGGBB`. Raises BadGoal if the text is none of these."""
    word = text.strip().lower()
    if word in named_colours():
        return named_colours()[word]
    match = _HEX.fullmatch(word)
    if match is None:
        raise BadGoal(
            field,
            text,
            ALLOWED,
            problem=f"unknown colour {text!r}{did_you_mean(word, named_colours())}",
        )
    return from_integer(int(match.group(1), 16))


def is_colour(text: str) -> bool:
    try:
        parse_colour(text)
    except BadGoal:
        return False
    return True


def from_integer(rgb: int) -> Colour:
    """A colour from 0x00RRGGBB."""
    return ((rgb >> 16 & 0xFF) / 255.0, (rgb >> 8 & 0xFF) / 255.0, (rgb & 0xFF) / 255.0)


def to_integer(colour: Colour) -> int:
    """A colour as 0x00RRGGBB."""
    red, green, blue = (round(255.0 * part) for part in colour)
    return red << 16 | green << 8 | blue
