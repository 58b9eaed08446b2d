"""The robot's files: paths of the robot, as clients name them, to paths on this computer and back."""

from __future__ import annotations

import logging
import os
import posixpath
import stat
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Iterator, Sequence, Tuple

from nao_sim_bridge.base.config import config_file, read_json, robot_files_directory, section
from nao_sim_bridge.base.errors import did_you_mean
from nao_sim_bridge.base.whole_file import FileTrouble, is_draft, tidy, write_whole

DEFAULT_RECORD_DIR = Path("~/.ros/nao_recordings")
# Longest part of a path, and longest path that clients may give, and that this system takes, in bytes.
LONGEST_PART, LONGEST_PATH, SYSTEM_LONGEST = 255, 4000, 4096
WORLD_ENDINGS = (".yaml", ".yml")
HOME_SIGNS = ("~", "~nao")
FILE = "robot_files.json"
log = logging.getLogger("nao_sim.files")


class OutsideRecordDir(ValueError):
    """A file name that leads out of the robot's places."""


class NoSuchFile(ValueError):
    """A file that a client names and that is not there."""


class IsFolder(NoSuchFile):
    """A folder where a client names a file."""


class UnusableName(ValueError):
    """A file name that cannot be that of a file, or of one that can be written."""


@dataclass(frozen=True)
class Place:
    """A folder of the robot.

    Attributes:
        path: On the robot.
        other_names: Further paths of it.
        folder: Where it is in the folder for files of clients.
        ours: Whether it has files that come with the simulator. Modules of the robot do not write to it.
    """

    path: str
    other_names: Tuple[str, ...]
    folder: str
    ours: bool


@lru_cache(maxsize=None)
def load_places() -> tuple[Place, ...]:
    """The robot's places; the first one is the home of its user."""
    entry = read_json(config_file(FILE))
    return tuple(section(Place, place, f"{FILE}: places") for place in entry["places"])


class ClientFiles:
    """The robot's file system, kept in one folder of this computer.

    That folder is the home of the robot's user, /home/nao; further places (/tmp, ...) are in a hidden folder in it. The
    log tells once for each folder where it is, when a path from the root on is written.

    Attributes:
        folder: Absolute.
        shipped: Folders that come with the simulator.

    Args:
        folder: See above; "~" stands for the home of the user of this computer.
        shipped: Where files are read from when the robot's home has none of the name.
    """

    def __init__(self, folder: Path | str, shipped: Sequence[Path] = ()) -> None:
        self.folder = Path(folder).expanduser().absolute()
        self.shipped = tuple(shipped)
        tidy(self.folder)
        # What modules of the robot have made or changed, and what was in it before; any thread.
        self._written: dict[Path, bytes | None] = {}
        self._told: set[Path] = set()  # folders that the log has told of

    # --- from the robot's paths to those of this computer -------------------------------------------------------------

    def to_write(self, name: str) -> Path:
        """Path of a file that a module of the robot is to write; folders on the way are made.

        Args:
            name: A path of the robot; "~" is the home of its user, where relative ones begin as well.

        Raises:
            OutsideRecordDir: The name leads out of the robot's places.
            UnusableName: It is too long, something else than a file is there, or its place is only read.
        """
        path = self._placed(name)
        place, _ = self._on_robot(path)
        if place.ours:
            writable = " or ".join(place.path for place in load_places() if not place.ours)
            raise UnusableName(f"{name!r} cannot be written: {place.path} is only read; write to {writable}")
        _make_ready(path, name)
        if not path.exists():
            self._written[path] = None
        if name.startswith("/") and path.parent not in self._told:
            self._told.add(path.parent)
            log.info("%s is %s on this computer; `nao files get %s` fetches it", name, path, name)
        return path

    def to_change(self, name: str) -> Path:
        """As `to_write`, for what the robot remembers from one run to the next: `forget` puts back what was in it."""
        path = self.to_write(name)
        if path not in self._written and path.exists():
            self._written[path] = path.read_bytes()
        return path

    def to_keep(self, name: str) -> Path:
        """As `to_write`, for who runs the simulator: to any place, and `forget` leaves it."""
        path = self.ready(name)
        self._written.pop(path, None)
        return path

    def ready(self, name: str) -> Path:
        """As `to_keep`, of what may never be written: `forget` still does what it would."""
        path = self._placed(name)
        _make_ready(path, name)
        return path

    def to_read(self, name: str) -> Path:
        """Path of a file that is there.

        Args:
            name: As for `to_write`.

        Raises:
            OutsideRecordDir: The name leads out of the robot's places.
            NoSuchFile: There is no such file.
            UnusableName: It is too long, or that of a place itself.
        """
        place, inner = self._named(name)
        candidates = [_inside(self.folder, f"{place.folder}/{inner}")]
        candidates += [_inside(root, inner) for root in self._coming_along(place)]
        found = [path for path in candidates if path]
        if not found:
            raise self._outside(name)
        for path in found:
            if path.is_file():
                return path
        if any(path.is_dir() for path in found):
            raise IsFolder(f"{name!r} is a folder, not a file")
        beside = [other.name for path in found if path.parent.is_dir() for other in path.parent.iterdir()]
        where = place.path if place.ours else self.folder / place.folder
        raise NoSuchFile(f"no file {name!r} in {where}{did_you_mean(posixpath.basename(inner), beside)}")

    def listed(self, name: str) -> dict[str, int]:
        """Bytes of the files in a folder of the robot, by name; the names of folders end with a slash.

        Raises:
            OutsideRecordDir: The name leads out of the robot's places.
            NoSuchFile: There is no such folder.
            UnusableName: It is too long.
        """
        place, inner = self._named(name, folder=True)
        roots = [(self.folder, f"{place.folder}/{inner}")]
        if place.ours:
            roots += [(root, inner) for root in self._coming_along(place)]
        found = [path for path in (_inside(*root, itself=True) for root in roots) if path and path.is_dir()]
        if not found and inner != ".":
            raise NoSuchFile(f"no folder {name!r} on the robot")
        hidden = {each.folder.partition("/")[0] for each in load_places()}
        listed: dict[str, int] = {}
        for entry in (entry for folder_here in reversed(found) for entry in folder_here.iterdir()):
            path = _without_links(entry)
            if path and self._on_robot(path) and entry.name not in hidden and not is_draft(entry.name):
                with suppress(FileNotFoundError):  # a link to nothing, or one that has gone meanwhile
                    about = path.stat()
                    is_folder = stat.S_ISDIR(about.st_mode)
                    listed[entry.name + "/" * is_folder] = 0 if is_folder else about.st_size
        return dict(sorted(listed.items()))

    # --- from the paths of this computer to the robot's ---------------------------------------------------------------

    def to_robot(self, path: Path | str) -> str:
        """The robot's path of a file that one of the other functions has given.

        Raises:
            OutsideRecordDir: It is none of the robot's files.
        """
        full = _without_links(Path(path))
        found = self._on_robot(full) if full else None
        if found is None:
            raise OutsideRecordDir(f"{path} is none of the robot's files, which are in {self.folder}")
        place, inner = found
        return posixpath.normpath(posixpath.join(place.path, inner))

    # --- what was made ------------------------------------------------------------------------------------------------

    def forget(self) -> None:
        """Remove the files that modules of the robot have made, and put back what was in those that they remember by.

        What was there before they wrote over it stays as they have written it.
        """
        while self._written:
            path, content = self._written.popitem()
            try:
                if content is None:
                    path.unlink(missing_ok=True)
                else:
                    write_whole(path, content)
            except (OSError, FileTrouble) as error:
                log.warning("%s stays as it is: %s", path, error)
            for folder in path.parents:
                if folder == self.folder or self.folder not in folder.parents:
                    break
                try:
                    folder.rmdir()  # only an empty one goes
                except OSError:
                    break

    # --- names --------------------------------------------------------------------------------------------------------

    def _named(self, name: str, folder: bool = False) -> tuple[Place, str]:
        """The place that a name leads to, and the rest of the path in there; "." is the place itself.

        Args:
            folder: Whether the place itself may be named.

        Raises:
            OutsideRecordDir: It leads to none of them.
            UnusableName: It is too long, or that of a place which may not be named.
        """
        _check_length(name)
        if name and "\0" not in name:
            full = full_path(name)
            for place in load_places():
                for known in (place.path, *place.other_names):
                    if full.startswith(known + "/"):
                        return place, full[len(known) + 1 :]
                    if full == known:
                        if not folder:
                            raise UnusableName(f"{name!r} is a folder, not a file")
                        return place, "."
        raise self._outside(name)

    def _placed(self, name: str) -> Path:
        """Path of a file of this name in the folder of its place, there or not."""
        place, inner = self._named(name)
        path = _inside(self.folder, f"{place.folder}/{inner}")
        if path is None:
            raise self._outside(name)
        return path

    def _on_robot(self, path: Path) -> tuple[Place, str] | None:
        """Place of a path of this computer, without links, and the rest of the path in there; None for other paths."""
        for place in reversed(load_places()):  # the home, which has the others in it, last
            for root in (self.folder / place.folder, *self._coming_along(place)):
                try:
                    return place, path.relative_to(root.resolve()).as_posix()
                except ValueError:
                    continue
        return None

    def _coming_along(self, place: Place) -> Iterator[Path]:
        """Folders that come with the simulator and belong to a place, too."""
        if place.ours:
            yield robot_files_directory() / place.path.lstrip("/")
        if place is load_places()[0]:
            yield from self.shipped

    def _outside(self, name: str) -> OutsideRecordDir:
        places = ", ".join(place.path for place in load_places())
        return OutsideRecordDir(
            f"file {name!r} is not inside the robot's places {places}, which are kept in {self.folder.resolve()};"
            " give a relative name"
        )


def full_path(name: str) -> str:
    """A path of the robot from its root on, without "~", "." and ".."; relative ones begin at the home of its user."""
    home = load_places()[0].path
    for sign in HOME_SIGNS:
        if name == sign or name.startswith(sign + "/"):
            name = home + name[len(sign) :]
    full = posixpath.normpath(posixpath.join(home, name))
    return "/" + full.lstrip("/")  # POSIX leaves two slashes as they are


def world_of_client(name: str, files: ClientFiles, first: str) -> str:
    """A world that a client names: one that comes along, or a file of the robot or beside the first.

    Args:
        name: Of the world, or path of its file: of the robot, or of this computer in one of these folders.
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
    try:
        return str(files.to_read(name))
    except (NoSuchFile, OutsideRecordDir):
        raise NoSuchFile(f"no world file {name!r} in {' or '.join(map(str, folders))}") from None


def unused(path: Path) -> Path:
    """A path at which there is no file yet: `path` itself, or name-2, name-3, ... beside it."""
    free, number = path, 1
    while free.exists():
        number += 1
        free = path.with_name(f"{path.stem}-{number}{path.suffix}")
    return free


def _make_ready(path: Path, name: str) -> None:
    """Make the folder of a file that is to be written; an UnusableName when there can be no such file."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UnusableName(f"the folder of {name!r} cannot be made: {error.strerror}") from error
    if path.exists() and not path.is_file():
        raise UnusableName(f"{name!r} cannot be written: {'Is a directory' if path.is_dir() else 'it is no file'}")


def _inside(folder: Path, name: str, itself: bool = False) -> Path | None:
    """Path of `name` inside `folder`, None when it leads out of it, also through a link; `itself`: it may be that."""
    _check_length(name)
    if not name or "\0" in name or Path(name).is_absolute():
        return None
    root = folder.resolve()
    path = _without_links(root / name)
    if path and len(os.fsencode(path)) >= SYSTEM_LONGEST:
        raise UnusableName(f"file {name[:40]!r}... is too long a name in {folder}")
    return path if path and (root in path.parents or (itself and path == root)) else None


def _without_links(path: Path) -> Path | None:
    """Where a path leads to, there or not; None where links lead to each other."""
    try:
        return path.resolve()
    except RuntimeError:
        return None


def _check_length(name: str) -> None:
    if len(os.fsencode(name)) > LONGEST_PATH or any(len(os.fsencode(p)) > LONGEST_PART for p in name.split("/")):
        raise UnusableName(f"file {name[:40]!r}... is too long a name: at most {LONGEST_PART} bytes a part are allowed")
