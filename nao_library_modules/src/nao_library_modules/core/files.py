"""Files: the folder of the configuration, atomic writes, and the persisted state of a node. No ROS."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import io
import itertools
import json
import logging
import os
import re
import shutil
import stat
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

from naoqi.errors import NaoError

log = logging.getLogger(__name__)

PACKAGE = "nao_library_modules"


def config_file(name: str) -> Path:
    """Path of a file or folder in `config`: beside the sources, or in the share directory of an installation.

    Raises FileNotFoundError if it is in neither place.
    """
    beside = Path(__file__).resolve().parents[3] / "config" / name
    if beside.exists():
        return beside
    import rospkg  # only an installation gets here, and it has ROS

    try:
        installed = Path(rospkg.RosPack().get_path(PACKAGE)) / "config" / name
    except rospkg.ResourceNotFound:
        installed = None
    if installed is not None and installed.exists():
        return installed
    raise FileNotFoundError(f"no configuration file {name}: looked beside the sources and in package {PACKAGE}")


def ros_home() -> Path:
    """The folder of what ROS and its programs keep for a user."""
    return Path(os.environ.get("ROS_HOME") or Path.home() / ".ros")


PART, BROKEN = ".part", ".broken"
_DRAFT = re.compile(r"\.nao_library-[0-9a-f]{32}\.draft")
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


class NoPlaceForFile(NaoError):
    """A file cannot be written where it is wanted. `path`: the file."""

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"{path} {problem}")
        self.path = path


class FileIsThere(NoPlaceForFile):
    """A file is not replaced unless that is asked for."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, "is there already: another name, or --overwrite")


class FileTrouble(NoPlaceForFile):
    """A file cannot be written; the text names it, and the room that is left where there is too little."""

    def __init__(self, path: Path, error: OSError) -> None:
        reason = error.strerror or str(error)
        if error.errno in FULL:
            with suppress(OSError):
                reason += f", {shutil.disk_usage(path.parent).free / 1e6:.1f} MB free in {path.parent}"
        super().__init__(path, f"cannot be written: {reason}")


def require_new(path: Path | str, overwrite: bool = False) -> Path:
    """Absolute path of a file that a program is about to write.

    Raises FileIsThere if there is such a file, and it is not to be replaced; NoPlaceForFile if there is no folder for
    it.
    """
    absolute = Path(path).expanduser().absolute()
    if absolute.exists() and not overwrite:
        raise FileIsThere(absolute)
    if not absolute.parent.is_dir():
        raise NoPlaceForFile(absolute, f"has no place: there is no folder {absolute.parent}")
    return absolute


class WholeFile(io.RawIOBase):
    """A file that others see only as far as it is whole. For one thread at a time.

    What is written waits in memory until `flush`, which puts all of it on the disk or nothing. With the first flush the
    file gets its name. Where there is a file of that name, it is called name.part1.end until it is closed, and takes
    the place of the former one only then. One that is closed without a flush before is not seen until it is complete.
    Raises FileTrouble if there can be no such file.

    Attributes:
        path: Its name at present, or the one that it will have.

    Args:
        path: Where; folders on the way are made.
        numbered: Whether, where there is a file of that name, it becomes name-2.end, name-3.end, ... and replaces none.
    """

    def __init__(self, path: Path, numbered: bool = False) -> None:
        """Begin; nobody sees it yet."""
        super().__init__()
        self.path = self._target = path
        self._numbered = numbered
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

    def flush(self) -> bool:
        """Put on the disk what waits, all of it or nothing; whether there was something.

        Raises FileTrouble if it cannot be written, nor can what comes behind it: there would be a hole.
        """
        if not self._waiting:
            return False
        with self._telling():
            self._put()
            if self._draft is not None:
                self._show()
        return True

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
                if self._draft is not None and self._numbered:
                    self._show()
                elif not self._numbered:
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
        self.path = _first_free(self._draft, self._target, *(("-", 2) if self._numbered else (PART, 1)))
        self._draft = None

    def _let_go(self) -> None:
        self._waiting.clear()
        self._file.close()
        if self._draft is not None:
            self._draft.unlink(missing_ok=True)
        super().close()


@contextmanager
def draft_in(folder: Path) -> Iterator[Path]:
    """An empty file for others to fill by its path; gone at the end unless it was moved. `tidy` leaves it alone."""
    path, file = _new_draft(folder)
    with file:
        try:
            yield path
        finally:
            path.unlink(missing_ok=True)


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


def write_whole(path: Path, content: str | bytes, numbered: bool = False) -> Path:
    """Write a file; one that is there already is replaced, and who reads it meanwhile gets the former one.

    Returns its path.

    Args:
        path: The file; its folder is made if it is not there.
        content: A text is written as UTF-8.
        numbered: See `WholeFile`.

    Raises:
        FileTrouble: It cannot be written; nothing has changed.
        UnicodeEncodeError: If the text has halves of characters.
    """
    data = content.encode() if isinstance(content, str) else content
    with WholeFile(path, numbered) as file:
        file.write(data)
    return file.path


def write_durable(path: Path, content: str | bytes) -> Path:
    """Write a file as `write_whole` does; when this returns the file survives a power cut, before that the former one.

    Returns its path. Raises FileTrouble if it cannot be written; nothing has changed.
    """
    data = content.encode() if isinstance(content, str) else content
    try:
        make_folder(path.parent)
        with draft_in(path.parent) as draft:
            with draft.open("wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.replace(draft, path)
        sync_folder(path.parent)
    except OSError as error:
        raise FileTrouble(path, error) from error
    return path


def make_folder(folder: Path) -> None:
    """Make a folder and those on the way that survive a power cut. Raises OSError."""
    if not folder.is_dir():
        make_folder(folder.parent)
        folder.mkdir(exist_ok=True)
        sync_folder(folder.parent)


def sync_folder(folder: Path) -> None:
    """Have the names in a folder on the disk. Raises OSError."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):  # not every file system can
            raise
    finally:
        os.close(descriptor)


def move_whole(path: Path, target: Path, overwrite: bool = False) -> Path:
    """Move a file, also to another disk. Until it is whole at its new place it is at the former one.

    `overwrite`: whether it replaces one that is there; else it becomes name-2.end, name-3.end, ... beside that one.
    Returns where it is now. Raises FileTrouble if it cannot be moved; nothing has changed.
    """
    draft = _draft_path(target.parent)
    try:
        if target.exists() and target.samefile(path):
            return target
        try:
            os.link(path, draft)
        except OSError:  # another disk, another owner, a file system without links
            draft, file = _new_draft(target.parent)
            with file:
                shutil.copy2(path, draft)
        if overwrite:
            os.replace(draft, target)
        else:
            target = _first_free(draft, target)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise FileTrouble(target, error) from error
    with suppress(OSError):  # of somebody else: it stays there as well
        path.unlink()
    return target


def written(path: Path, wanted: Path) -> str:
    """What is told of a file that was written: where it is, and why not where it was wanted."""
    return f"written: {path}" if path == wanted else f"written: {path}, for {wanted.name} came meanwhile"


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


def give_name(draft: Path, name: Path) -> bool:
    """Give a file another name unless there is a file of that name; whether it got it."""
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


def _first_free(draft: Path, target: Path, mark: str = "-", first: int = 2) -> Path:
    """Give a file the first of `numbered_names` that is free; which it is."""
    return next(name for name in numbered_names(target, mark, first) if give_name(draft, name))


def numbered_names(target: Path, mark: str = "-", first: int = 2) -> Iterator[Path]:
    """A name, and after it those with a number: name-2, name-3, ..."""
    yield target
    for number in itertools.count(first):
        yield target.with_name(f"{target.stem}{mark}{number}{target.suffix}")


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


UNUSABLE = (NaoError, OSError, ValueError, TypeError, LookupError, ArithmeticError, AttributeError, RecursionError)
"""What reading a file of anything may raise."""
Read = TypeVar("Read")


class Kept:
    """The file of one node; `run` is the same in a node that was started again, and in no other run."""

    def __init__(self, path: Path, run: str) -> None:
        self._path = path
        self._run = run
        self._forgotten = False

    def load(self, read: Callable[[Any], Read]) -> Read | None:
        """What `read` makes of what was kept in this run; None if nothing was.

        A file that cannot be used is put aside, and nothing was kept.

        Args:
            read: Raises any of `UNUSABLE` where the value is not one that was saved.
        """
        try:
            told = json.loads(self._path.read_text(encoding="utf-8"))
            _encoded(told)
            return read(told["kept"]) if told["run"] == self._run else None
        except FileNotFoundError:
            return None
        except UNUSABLE as error:
            put_aside(self._path, error, "this node begins without what was set up")
            return None

    def save(self, value: Any) -> None:
        """Keep a value that JSON has words for, instead of the former one; a full disk is no reason to refuse it."""
        if self._forgotten:
            return
        try:
            write_whole(self._path, _encoded({"run": self._run, "kept": value}))
        except (FileTrouble, ValueError, RecursionError) as error:
            log.warning("if this node dies it will not know what was set up: %s", error)

    def forget(self) -> None:
        """Keep nothing any more, neither what there is nor what the steps of the node's end would save."""
        self._forgotten = True
        with contextlib.suppress(OSError):
            self._path.unlink()


def _encoded(value: Any) -> bytes:
    """The bytes of a file; a ValueError for numbers that are not finite and halves of characters."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False).encode()
