"""The one folder that clients may have files written to, and the places that they may have files read from."""

from __future__ import annotations

import logging
import os
import posixpath
from pathlib import Path
from typing import Sequence

from nao_sim_bridge.base.whole_file import tidy

DEFAULT_RECORD_DIR = Path("~/.ros/nao_recordings")
# Where a real robot keeps the files of its users. Scripts that were written for one name it in full.
ROBOT_HOME = "/home/nao"
# Longest part of a path, and longest path, in bytes; no file system here has longer ones.
LONGEST_PART, LONGEST_PATH = 255, 4000
WORLD_ENDINGS = (".yaml", ".yml")
log = logging.getLogger("nao_sim.files")


class OutsideRecordDir(ValueError):
    """A file name that leads out of the folder for recordings."""


class NoSuchFile(ValueError):
    """A file that a client names and that is not there."""


class UnusableName(ValueError):
    """A file name that cannot be that of a file, or of one that can be written."""


class ClientFiles:
    """Turns file names of clients into paths that they may use.

    Attributes:
        folder: The folder for recordings, absolute.
        shipped: Folders that come with the simulator.

    Args:
        folder: See above; "~" stands for the home of the user.
        shipped: Where files are read from when `folder` has none of the name.
    """

    def __init__(self, folder: Path | str, shipped: Sequence[Path] = ()) -> None:
        self.folder = Path(folder).expanduser().absolute()
        self.shipped = tuple(shipped)
        tidy(self.folder)
        self._made: dict[Path, None] = {}  # in the order in which they were asked for; any thread

    def to_write(self, name: str) -> Path:
        """Path of a file that a module of the robot is to write; folders on the way are made.

        Raises:
            OutsideRecordDir: The name leads out of the folder.
            UnusableName: It is too long, or something else than a file is there.
        """
        path = self.to_keep(name)
        if not path.exists():
            self._made[path] = None
        return path

    def forget(self) -> None:
        """Remove the files that modules of the robot have made; what was there before they wrote to it stays."""
        for path in list(self._made):
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                log.warning("%s stays: %s", path, error.strerror)
            for folder in path.parents:
                if folder == self.folder or self.folder not in folder.parents:
                    break
                try:
                    folder.rmdir()  # only an empty one goes
                except OSError:
                    break

    def to_keep(self, name: str) -> Path:
        """As `to_write`, for who runs the simulator: `forget` leaves it."""
        path = inside(self.folder, relative_to_home(name))
        if path.exists() and not path.is_file():
            raise UnusableName(f"{name!r} cannot be written: {'Is a directory' if path.is_dir() else 'it is no file'}")
        return path

    def to_read(self, name: str) -> Path:
        """Path of a file that is there.

        Raises:
            OutsideRecordDir: The name leads out of the folder.
            NoSuchFile: There is no such file.
            UnusableName: It is too long.
        """
        relative = relative_to_home(name)
        found = [path for path in (_inside(folder, relative) for folder in (self.folder, *self.shipped)) if path]
        if not found:
            raise _outside(self.folder, name)
        for path in found:
            if path.is_file():
                return path
        if any(path.is_dir() for path in found):
            raise NoSuchFile(f"{name!r} is a folder, not a file")
        raise NoSuchFile(f"no file {name!r} in {self.folder}")


def world_of_client(name: str, files: ClientFiles, first: str) -> str:
    """A world that a client names: one that comes along, or a file in the folder for recordings or beside the first.

    Args:
        name: Of the world, or path of its file, in full or from one of these folders.
        first: The world in which the simulator was started, which may be elsewhere.

    Raises:
        NoSuchFile: There is no such file in these folders.
        UnusableName: It is too long.
    """
    if name in ("", first) or Path(name).suffix not in WORLD_ENDINGS:
        return name
    folders = [files.folder, *([Path(first).absolute().parent] if Path(first).suffix in WORLD_ENDINGS else [])]
    for folder in folders:
        in_full = Path(name).is_absolute() and "\0" not in name
        path = _inside(folder, os.path.relpath(os.path.realpath(name), folder.resolve()) if in_full else name)
        if path is not None and path.is_file():
            return str(path)
    raise NoSuchFile(f"no world file {name!r} in {' or '.join(map(str, folders))}")


def unused(path: Path) -> Path:
    """A path at which there is no file yet: `path` itself, or name-2, name-3, ... beside it."""
    free, number = path, 1
    while free.exists():
        number += 1
        free = path.with_name(f"{path.stem}-{number}{path.suffix}")
    return free


def relative_to_home(name: str) -> str:
    """A name as clients give it, without a real robot's home in front: the folder for recordings stands for it."""
    if posixpath.normpath(name).startswith(ROBOT_HOME + "/"):
        return posixpath.relpath(name, ROBOT_HOME)
    return name


def inside(folder: Path, name: str) -> Path:
    """Path of `name` inside `folder`; missing folders on the way are made.

    Raises:
        OutsideRecordDir: The name is absolute, empty, or leads out of the folder, also through a link.
        UnusableName: It is too long, or a folder on the way cannot be made.
    """
    path = _inside(folder, name)
    if path is None:
        raise _outside(folder, name)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UnusableName(f"the folder of {name!r} cannot be made: {error.strerror}") from error
    return path


def _inside(folder: Path, name: str) -> Path | None:
    """Path of `name` inside `folder`, None when it leads out of it."""
    if len(os.fsencode(name)) > LONGEST_PATH or any(len(os.fsencode(p)) > LONGEST_PART for p in name.split("/")):
        raise UnusableName(f"file {name[:40]!r}... is too long a name: at most {LONGEST_PART} bytes a part are allowed")
    if not name or "\0" in name or Path(name).is_absolute():
        return None
    root = folder.resolve()
    path = (root / name).resolve()
    return path if root in path.parents else None


def _outside(folder: Path, name: str) -> OutsideRecordDir:
    return OutsideRecordDir(f"file {name!r} is not inside {folder.resolve()}; give a relative name")
