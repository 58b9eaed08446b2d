"""The one way to write a file: others see of it only what is whole, and a file that it replaces stays until then."""

from __future__ import annotations

import errno
import fcntl
import io
import itertools
import logging
import os
import re
import shutil
import stat
import uuid
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Iterator

from nao_sim_bridge.base.errors import SimulationError

log = logging.getLogger("nao_sim.files")

PART, BROKEN = ".part", ".broken"
_DRAFT = re.compile(r"\.nao_library-[0-9a-f]{32}\.draft")
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


class FileTrouble(SimulationError):
    """A file cannot be written; the text names it, and the room that is left where there is too little.

    Attributes:
        path: The file.
    """

    def __init__(self, path: Path, error: OSError) -> None:
        reason = error.strerror or str(error)
        if error.errno in FULL:
            with suppress(OSError):
                reason += f", {shutil.disk_usage(path.parent).free / 1e6:.1f} MB free in {path.parent}"
        super().__init__(f"{path} cannot be written: {reason}")
        self.path = path


class WholeFile(io.RawIOBase):
    """A file that others see only as far as it is whole. For one thread at a time.

    What is written waits in memory until `flush`, which puts all of it on the disk or nothing. With the first flush the
    file gets its name. Where there is a file of that name, it is called name.part1.end until it is closed, and takes
    the place of the former one only then. One that is closed without a flush before is not seen until it is complete.

    Attributes:
        path: Its name at present, or the one that it will have.

    Args:
        path: Where; folders on the way are made.
        hidden: Whether it gets its name only when it is closed.

    Raises:
        FileTrouble: There can be no such file.
    """

    def __init__(self, path: Path, hidden: bool = False) -> None:
        super().__init__()
        self.path = self._target = path
        self._hidden = hidden
        self._waiting: list[tuple[int, bytes]] = []
        self._place = self._end = self._length = 0
        self._trouble: FileTrouble | None = None
        with self._telling():
            path.parent.mkdir(parents=True, exist_ok=True)
            self._draft: Path | None
            self._draft, self._file = _new_draft(path.parent)

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def tell(self) -> int:
        """Place of the next write."""
        return self._place

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        self._place = offset + {io.SEEK_SET: 0, io.SEEK_CUR: self._place, io.SEEK_END: self._end}[whence]
        return self._place

    def write(self, content: Any) -> int:
        """Have bytes wait for the next flush."""
        kept = bytes(content)
        self._waiting.append((self._place, kept))
        self._place += len(kept)
        self._end = max(self._end, self._place)
        return len(kept)

    def flush(self) -> None:
        """Put on the disk what waits, all of it or nothing. After an error everything is refused, until `recover`.

        Raises:
            FileTrouble: It cannot be written.
        """
        if self._waiting:
            with self._telling():
                self._put()
                if self._draft is not None and not self._hidden:
                    self._show()

    def recover(self) -> None:
        """Go on behind what is on the disk."""
        self._waiting.clear()
        self._place = self._end = self._length
        self._trouble = None

    def close(self) -> None:
        """Put on the disk what waits, and replace a former file of that name.

        Raises:
            FileTrouble: It is not complete. What is on the disk of it stays, and so does the former file.
        """
        if self.closed:
            return
        try:
            with self._telling():
                self._put()
                os.replace(self._draft or self.path, self._target)
            self._draft, self.path = None, self._target
        finally:
            self._let_go()

    def discard(self) -> None:
        """Write nothing any more, and remove what there is of it; a former file stays."""
        if not self.closed:
            if self._draft is None:
                self.path.unlink(missing_ok=True)
            self._let_go()

    def __exit__(self, kind: Any, *_: Any) -> None:
        """Close it, or discard it when something went wrong."""
        (self.close if kind is None else self.discard)()

    def __del__(self) -> None:
        """What nobody has closed is not complete: it stays as that of a killed process does."""

    @contextmanager
    def _telling(self) -> Iterator[None]:
        if self._trouble is not None:
            self._waiting.clear()
            raise self._trouble
        try:
            yield
        except OSError as error:
            self._trouble = FileTrouble(self.path, error)
            raise self._trouble from error

    def _put(self) -> None:
        waiting, self._waiting = self._waiting, []
        try:
            for place, content in waiting:
                view = memoryview(content)
                while view:
                    written = os.pwrite(self._file.fileno(), view, place)
                    view, place = view[written:], place + written
        except OSError:
            os.ftruncate(self._file.fileno(), self._length)
            raise
        self._length = self._end

    def _show(self) -> None:
        """Give the draft the first name that is free."""
        target = self._target
        parts = (target.with_name(f"{target.stem}{PART}{number}{target.suffix}") for number in itertools.count(1))
        for name in itertools.chain([target], parts):
            if _named(self._draft, name):
                self._draft, self.path = None, name
                return

    def _let_go(self) -> None:
        self._waiting.clear()
        self._file.close()
        if self._draft is not None:
            self._draft.unlink(missing_ok=True)
        super().close()


def is_draft(name: str) -> bool:
    """Whether a file of this name is a draft of this library: nobody else names one so, not even by accident."""
    return _DRAFT.fullmatch(name) is not None


def _draft_name(token: str) -> str:
    return f".nao_library-{token}.draft"


def _draft_path(folder: Path) -> Path:
    return folder / _draft_name(uuid.uuid4().hex)


def _new_draft(folder: Path) -> tuple[Path, io.FileIO]:
    """A new file that `tidy` leaves alone as long as it is open; its rights are those of the umask."""
    while True:
        path = _draft_path(folder)
        file = io.FileIO(str(path), "xb")
        with suppress(OSError):  # not every file system knows locks
            fcntl.flock(file, fcntl.LOCK_EX)
        if os.fstat(file.fileno()).st_nlink:
            return path, file
        file.close()  # `tidy` of another process came between


def write_whole(path: Path, content: bytes) -> None:
    """Write a file; one that is there already is replaced, and who reads it meanwhile gets the former one.

    Raises:
        FileTrouble: It cannot be written; nothing has changed.
    """
    with WholeFile(path) as file:
        file.write(content)


def tidy(folder: Path) -> None:
    """Remove drafts that killed processes have left in a folder, and name their recordings that replace nothing.

    Removed is only what has the name of a draft, belongs to this user and is being written by nobody.
    """
    for path in folder.rglob(_draft_name("*")):
        if is_draft(path.name):
            _remove_left(path)
    for path in folder.rglob(f"*{PART}[0-9]*"):
        if _nobody_writes(path):
            log.warning("%s is a recording that was not ended; what was to be replaced by it is still there", path)


def put_aside(path: Path, reason: object, without: str) -> Path | None:
    """Give what cannot be used another name, which replaces nothing: name.broken, name.broken2, ... The log tells it.

    Returns the new one, None if it cannot be renamed.

    Args:
        path: Whatever is there: a file, a folder, something else.
        reason: Why it cannot be used.
        without: What happens now, for the log: "the robot begins without users".
    """
    for number in itertools.count(1):
        aside = path.with_name(f"{path.name}{BROKEN}{number if number > 1 else ''}")
        if os.path.lexists(aside):
            continue
        try:
            path.rename(aside)
        except OSError as error:
            log.error("%s cannot be used: %s; it stays (%s), and %s", path, reason, error.strerror or error, without)
            return None
        log.error("%s cannot be used: %s; it is kept as %s, and %s", path, reason, aside, without)
        return aside


def _named(draft: Path, name: Path) -> bool:
    """Give a file a name unless another one has it; whether it got it."""
    try:
        os.link(draft, name)
        draft.unlink()
    except FileExistsError:
        return False
    except OSError:  # not every file system knows links
        if name.exists():
            return False
        os.replace(draft, name)
    return True


def _remove_left(path: Path) -> None:
    """Remove a draft unless somebody writes it; who has just begun it notices (`_new_draft`)."""
    with suppress(OSError):
        about = path.lstat()
        if stat.S_ISREG(about.st_mode) and about.st_uid == os.geteuid():
            with path.open("rb") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                path.unlink()


def _nobody_writes(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
