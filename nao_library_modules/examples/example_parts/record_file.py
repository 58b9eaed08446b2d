"""Records of examples as JSON files: a format, units, and entries of one kind."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any, Callable, List, Sequence, TypeVar

from nao_library_modules.core.files import write_whole
from naoqi.errors import NaoError

Entry = TypeVar("Entry")


class RecordError(NaoError):
    """A file that is not such a record."""


def save_record(path: Path, form: str, units: str, entry: str, entries: Sequence[Any]) -> None:
    """Write dataclasses as entries, under the plural of their word."""
    content = {"format": form, "units": units, f"{entry}s": [asdict(each) for each in entries]}
    write_whole(path, json.dumps(content, indent=1) + "\n")


def load_record(path: Path, form: str, entry: str, read: Callable[[Any], Entry]) -> List[Entry]:
    """Read what `save_record` wrote.

    Raises:
        RecordError: The file cannot be read, is of another format, or `read` refuses an entry.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RecordError(f"{path}: cannot be read: {error}") from error
    if not isinstance(content, dict) or content.get("format") != form:
        raise RecordError(f"{path}: is no record: format is not {form!r}")
    try:
        return [read(each) for each in content[f"{entry}s"]]
    except (KeyError, TypeError, ValueError) as error:
        raise RecordError(f"{path}: has a {entry} that is wrong: {error!r}") from error
