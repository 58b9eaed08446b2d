"""Folders of the robot that programs name. Paths are those of the robot, not of this computer."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable

HOME = "/home/nao"
"""Home of the robot's user, where relative names begin. The simulator keeps it in its `record_dir`."""
WRITTEN = (HOME, "/tmp")
"""Where programs leave files."""
READ = (*WRITTEN, "/usr/share/naoqi", "/opt/aldebaran/share/naoqi", "/opt/naoqi/share/naoqi", "/opt/naoqi/data")
"""Where they find some: the last four have the sounds of the robot, up to V5, on V6 and in the first versions."""
_HOME_SIGN = re.compile(r"\A~(nao)?(?=/|\Z)")
_OTHER_HOME = re.compile(r"\A(/data|/var/persistent)(?=/home/nao(/|\Z))")
"""The partition with the home: on V6 and before."""


def without_sign(name: str) -> str:
    """A path that does not begin with "~": programs of the robot take it for the name of a folder."""
    return _HOME_SIGN.sub(HOME, name)


def full_path(name: str) -> str:
    """A path from the root on, without "~", "." and "..", in the home by the name that is the same on all robots."""
    full = posixpath.normpath(posixpath.join(HOME, without_sign(name)))
    return _OTHER_HOME.sub("", "/" + full.lstrip("/"))


def is_in(name: str, folders: Iterable[str]) -> bool:
    """Whether a path leads into one of the folders, whatever it has of ".."."""
    return any(full_path(name).startswith(f"{folder}/") for folder in folders)
