"""The folder that pictures and videos of goals go to, and the names of files in it. No ROS."""

from __future__ import annotations

import errno
import os
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO

from naoqi.errors import NaoError

from .errors import BadGoal
from .field_checks import CONTROL, LONGEST_NAME
from .suggestion import did_you_mean

DEFAULT_RECORD_DIR = "~/.ros/nao_recordings"
"""As that of the simulator: beside a simulated robot on the same computer, its files and these are in one place."""
SYNONYMS = {"jpeg": "jpg", "tif": "tiff"}


class FileTrouble(NaoError):  # noqa: N818  named like the errors of the proxy layer
    """A file cannot be written.

    Attributes:
        path: The file.
    """

    def __init__(self, path: Path, error: OSError) -> None:
        """Compose the text.

        Args:
            path: The file.
            error: What the system says.
        """
        problem = "the disk is full" if error.errno in (errno.ENOSPC, errno.EDQUOT) else error.strerror or str(error)
        super().__init__(f"{path} cannot be written: {problem}")
        self.path = path


class VisionFiles:
    """Files of one server. May be used by several threads.

    Attributes:
        folder: Where they are; absolute.
    """

    def __init__(self, folder: str) -> None:
        """Make nothing yet.

        Args:
            folder: "~" stands for the home of the user; relative to the working directory, which is ROS_HOME for a
                node that a launch file started.
        """
        self.folder = Path(folder).expanduser().absolute()
        self._lock = threading.Lock()
        self._open: set[Path] = set()  # what a recording of this server writes: nobody may replace it

    def file_type(self, name: str, file_type: str, known: Sequence[str]) -> str:
        """Kind of a file: as its field says, as its name ends, or the first of those known.

        Raises:
            BadGoal: If it is not known, or name and field differ.
        """
        field = _kind(file_type)
        end = _kind(Path(name.strip()).suffix) if name.strip() else ""
        for source, value in (("file_type", field), ("str_param", end)):
            if value and value not in known:
                problem = f"{value!r} is no type of file for this{did_you_mean(value, known)}"
                raise BadGoal(source, value, f"one of {', '.join(known)}", problem=problem)
        if field and end and field != end:
            allowed = f"{end}, as the file's name ends"
            raise BadGoal("file_type", file_type, allowed, problem=f"{name!r} is no {field}")
        return field or end or known[0]

    def path(self, name: str, file_type: str) -> Path:
        """Path of a file that a goal names; its folder may have to be made.

        Args:
            name: Relative to the folder, or absolute and inside it, with or without the end that tells its type.
            file_type: Its type.

        Raises:
            BadGoal: If it leads out of the folder or cannot be a name.
        """
        allowed = f"a name of a file in {self.folder}"
        bare = name.strip()
        if CONTROL.search(bare) or bare.startswith("~") or bare.endswith("/"):
            raise BadGoal("str_param", name, allowed, problem=f"{name!r} is not the name of a file")
        if any(len(os.fsencode(part)) > LONGEST_NAME - len("-000.webp") for part in Path(bare).parts):
            raise BadGoal("str_param", name, f"up to {LONGEST_NAME - 10} bytes", problem="the name is too long")
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

        Raises:
            BadGoal: If it is there and may not be replaced, or a recording writes it.
        """
        with self._lock:
            busy = path in self._open
        if busy:
            raise BadGoal("str_param", path.name, "another name", problem=f"a recording is writing {path}")
        if path.exists() and not overwrite:
            raise BadGoal("str_param", path.name, "another name, or overwrite", problem=f"{path} is there already")

    def named_by_time(self, prefix: str, file_type: str) -> Path:
        """Path for a file that a goal does not name: what it is, and the time of day."""
        now = time.time()
        stamp = time.strftime("%Y-%m-%d_%H-%M-%S", time.localtime(now))
        return self.folder.resolve() / f"{prefix}_{stamp}.{int(now * 1000) % 1000:03d}.{file_type}"

    def create(self, path: Path, overwrite: bool = False, numbered: bool = False) -> tuple[BinaryIO, Path]:
        """Open a file that is to be written.

        Args:
            path: Which.
            overwrite: Whether one that is there is replaced.
            numbered: Whether one that is there lets this one become name-2, name-3, ...

        Returns:
            The file, and its path.

        Raises:
            BadGoal: If it is there and is neither to be replaced nor to be numbered.
            FileTrouble: If it cannot be written.
        """
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with self._lock:
                file, path = self._opened(path, overwrite, numbered)
                self._open.add(path)
        except OSError as error:
            raise FileTrouble(path, error) from error
        return file, path

    def _opened(self, path: Path, overwrite: bool, numbered: bool) -> tuple[BinaryIO, Path]:
        if overwrite and path not in self._open:
            return path.open("wb"), path
        free, number = path, 1
        while True:
            try:
                return free.open("xb"), free
            except FileExistsError:
                if not numbered:
                    raise BadGoal(
                        "str_param", path.name, "another name, or overwrite", problem=f"{path} is there already"
                    ) from None
                number += 1
                free = path.with_name(f"{path.stem}-{number}{path.suffix}")

    def done(self, path: Path) -> None:
        """Note that a file is complete: it may be replaced from now on."""
        with self._lock:
            self._open.discard(path)

    def write(self, path: Path, data: bytes, overwrite: bool = False, numbered: bool = False) -> Path:
        """Write a whole file; one that cannot be written whole is not left behind.

        Takes what `create` takes, and the bytes.

        Returns:
            Its path.
        """
        file, path = self.create(path, overwrite, numbered)
        try:
            with file:
                file.write(data)
        except OSError as error:
            path.unlink()
            raise FileTrouble(path, error) from error
        finally:
            self.done(path)
        return path


def _kind(text: str) -> str:
    bare = text.strip().lower().lstrip(".")
    return SYNONYMS.get(bare, bare)
