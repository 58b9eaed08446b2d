"""Files that are written as a whole or not at all: who reads one meanwhile gets the former one. No ROS."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

MODE = 0o644
"""Everybody reads, the owner writes: drafts are made for their owner alone."""


def write_whole(path: Path, text: str) -> None:
    """Write a text; a file that is there already is replaced.

    Args:
        path: The file; its folder is made if it is not there.
        text: Written as UTF-8.

    Raises:
        OSError: If it cannot be written.
        UnicodeEncodeError: If the text has halves of characters.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    descriptor, draft = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".draft")
    try:
        with os.fdopen(descriptor, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(draft, MODE)
        os.replace(draft, path)
    except BaseException:
        os.unlink(draft)
        raise
