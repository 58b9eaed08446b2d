"""The one folder that clients may have files written to."""

from __future__ import annotations

from pathlib import Path


class OutsideRecordDir(ValueError):
    """A file name that leads out of the folder for recordings."""


def inside(folder: Path, name: str) -> Path:
    """Path of `name` inside `folder`; missing folders on the way are made.

    Raises:
        OutsideRecordDir: The name is absolute, empty, or leads out of the folder, also through a link.
    """
    root = folder.resolve()
    path = (root / name).resolve()
    if not name or Path(name).is_absolute() or root not in path.parents:
        raise OutsideRecordDir(f"file {name!r} is not inside {root}; give a relative name")
    path.parent.mkdir(parents=True, exist_ok=True)
    return path
