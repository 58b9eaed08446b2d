"""Reads files that others bring, up to a size: counted while reading, whatever their folder says."""

from __future__ import annotations

from pathlib import Path


class TooLarge(ValueError):
    """A file that is larger than what is allowed; the text says what is."""


def read_bounded(path: Path, largest: int) -> bytes:
    """All of a file.

    Raises:
        TooLarge: It has more than `largest` bytes.
        OSError: It cannot be read.
    """
    with open(path, "rb") as file:
        content = file.read(largest + 1)
    if len(content) > largest:
        raise TooLarge(f"has more than {largest} bytes")
    return content
