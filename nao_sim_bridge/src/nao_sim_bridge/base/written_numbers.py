"""Whole numbers that clients write in texts."""

from __future__ import annotations

LONGEST = 12
"""Digits; Python itself reads some thousand and no more."""


def written_number(text: str, most: float) -> int | None:
    """The number, 0 to `most`, that a text writes in the digits 0 to 9; None for any other text."""
    number = int(text) if text.isascii() and text.isdigit() and len(text) <= LONGEST else None
    return number if number is not None and number <= most else None
