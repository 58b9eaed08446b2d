"""The folder for pictures and videos of goals, and the names of files in it. No ROS."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Sequence
from pathlib import Path

from ...base.errors import BadGoal
from ...base.field_checks import CONTROL, LONGEST_NAME, require_known
from ...base.whole_file import WholeFile, numbered_names, tidy

DEFAULT_RECORD_DIR = "~/.ros/nao_recordings"
"""As that of the simulator: beside a simulated robot on the same computer, its files and these are in one place."""
TYPE_SYNONYMS = {"jpeg": "jpg", "tif": "tiff"}
SHORT = f"up to {LONGEST_NAME - 10} bytes"


class VisionFiles:
    """Files of one server. Any thread."""

    def __init__(self, folder: str) -> None:
        """Remove what killed servers have left; nothing is made yet.

        `folder`: "~" stands for the home of the user; relative to the working directory, which is ROS_HOME for a node
        that a launch file started.
        """
        self.folder = Path(folder).expanduser().absolute()
        self._lock = threading.Lock()
        self._open: set[Path] = set()  # being written: must not be replaced
        tidy(self.folder)

    def file_type(self, name: str, file_type: str, known: Sequence[str]) -> str:
        """Type of a file: that of the field, of the end of the name, or the first known one.

        Raises BadGoal if it is not known, or name and field differ.
        """
        field = known_type("file_type", file_type, known)
        end = known_type("str_param", Path(name.strip()).suffix, known)
        if field and end and field != end:
            allowed = f"{end}, as the file's name ends"
            raise BadGoal("file_type", file_type, allowed, problem=f"{name!r} is no {field}")
        return field or end or known[0]

    def path(self, name: str, file_type: str) -> Path:
        """Path of a file that a goal names; its folder may have to be made.

        `name`: relative to the folder, or absolute and inside it, with or without a suffix. `file_type`: suffix where
        the name has none. Raises BadGoal if it leads out of the folder or cannot be a name.
        """
        allowed = f"a name of a file in {self.folder}"
        bare = name.strip()
        if CONTROL.search(bare) or bare.startswith("~") or bare.endswith("/"):
            raise BadGoal("str_param", name, allowed, problem=f"{name!r} is not the name of a file")
        require_short("str_param", name)
        root = self.folder.resolve()
        path = (root / bare).resolve()
        if root not in path.parents:
            raise BadGoal("str_param", name, allowed, problem=f"{name!r} leads out of the folder for recordings")
        if not path.suffix:
            path = path.with_name(f"{path.name}.{file_type}")
        if path.exists() and not path.is_file():
            raise BadGoal("str_param", name, allowed, problem=f"{path} is a folder or something else that is no file")
        return path

    def require_free(self, path: Path, overwrite: bool) -> None:
        """Check that a file may be written.

        Raises BadGoal if it exists and may not be replaced, or a recording writes it.
        """
        with self._lock:
            busy = path in self._open
        if busy:
            raise BadGoal("str_param", path.name, "another name", problem=f"a recording is writing {path}")
        if path.exists() and not overwrite:
            raise BadGoal("str_param", path.name, "another name, or overwrite", problem=f"{path} is there already")

    def plan(self, path: Path, overwrite: bool, planned: set[Path]) -> None:
        """Check that a file may be written after the planned ones, and add it to these.

        Raises BadGoal as `require_free`, or if an earlier function of the chain writes it.
        """
        self.require_free(path, overwrite)
        if path in planned and not overwrite:
            problem = f"an earlier function writes {path}"
            raise BadGoal("str_param", path.name, "another name, or overwrite", problem=problem)
        planned.add(path)

    def named_by_time(self, prefix: str, file_type: str) -> Path:
        """Path of a file that a goal does not name: a prefix and the local time."""
        now = time.time()
        stamp = time.strftime("%Y-%m-%d_%H-%M-%S", time.localtime(now))
        return self.folder.resolve() / f"{prefix}_{stamp}.{int(now * 1000) % 1000:03d}.{file_type}"

    def create(self, path: Path, overwrite: bool = False, numbered: bool = False) -> WholeFile:
        """Open a file for writing; call `done` at its end.

        Raises BadGoal if it exists and is neither to be replaced nor to be numbered, FileTrouble if it cannot be
        written.

        Args:
            path: See `path`.
            overwrite: Whether an existing file is replaced.
            numbered: Whether this file becomes name-2, name-3, ... beside an existing one.
        """
        with self._lock:
            names = numbered_names(path) if numbered else [path]
            free = next((n for n in names if n not in self._open and (overwrite or not n.exists())), None)
            if free is None:
                problem = f"{path} is there already"
                raise BadGoal("str_param", path.name, "another name, or overwrite", problem=problem)
            file = WholeFile(free, numbered)
            self._open.add(free)
        return file

    def done(self, path: Path) -> None:
        """Take note that a file is complete: it may be replaced from now on."""
        with self._lock:
            self._open.discard(path)

    def write(self, path: Path, data: bytes, overwrite: bool = False, numbered: bool = False) -> Path:
        """Write a whole file, as `create` takes it; answers its path."""
        file = self.create(path, overwrite, numbered)
        wanted = file.path
        try:
            with file:
                file.write(data)
        finally:
            self.done(wanted)
        return file.path


def known_type(field: str, text: str, known: Sequence[str]) -> str:
    """Usual name of a type of file; empty for none. Raises BadGoal if it is not known."""
    bare = text.strip().lower().lstrip(".")
    kind = TYPE_SYNONYMS.get(bare, bare)
    return require_known(field, kind, known, "type of file for this") if kind else ""


def require_short(field: str, name: str) -> None:
    """Check that file systems take each part of a path, also with a number and a suffix behind it."""
    if any(len(os.fsencode(part)) > LONGEST_NAME - len("-000.webp") for part in Path(name.strip()).parts):
        raise BadGoal(field, name, SHORT, problem="the name is too long")
