"""Folders of the robot that programs name. Paths are those of the robot, not of this computer."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable

HOME = "/home/nao"
"""Home of the robot's user, where relative names begin. The simulator keeps it in its `record_dir`."""
WRITTEN = (HOME, "/tmp")
"""Where programs leave files."""
READ = (*WRITTEN, "/usr/share/naoqi", "/opt/aldebaran/share/naoqi")
"""Where they find some: the last two have the sounds of the robot, up to V5 and on V6."""


def full_path(name: str) -> str:
    """A path from the root on, without "~", "." and ".."."""
    if name == "~" or name.startswith("~/"):
        name = HOME + name[1:]
    return "/" + posixpath.normpath(posixpath.join(HOME, name)).lstrip("/")


def is_in(name: str, folders: Iterable[str]) -> bool:
    """Whether a path leads into one of the folders, whatever it has of ".."."""
    return any(full_path(name).startswith(f"{folder}/") for folder in folders)
