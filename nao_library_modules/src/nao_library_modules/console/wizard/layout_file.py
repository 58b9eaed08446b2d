"""The wizard's file on the disk: read, watched for changes, and saved if nobody else has changed it. No ROS."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from ...base.whole_file import write_whole
from ...behaviors.language.errors import Problem
from ..files.yaml_file import ConsoleFileError, revision_of
from .errors import EditConflict
from .model import WizardLayout
from .reader import read_layout


class SavedText(NamedTuple):
    """The text of a file, and what tells it from another one."""

    text: str
    revision: str


class LayoutFile:
    """One file, and the example that stands for it while it is not there.

    Args:
        path: The file; only this one is ever written.
        example: Read while there is no such file.
    """

    def __init__(self, path: Path, example: Path) -> None:
        self.path = path
        self._example = example

    @property
    def mark(self) -> tuple[int, int]:
        """Changes when the file does: time of the last change, ns, and length; zeros if it is not there."""
        try:
            found = self.path.stat()
        except OSError:
            return (0, 0)
        return (found.st_mtime_ns, found.st_size)

    def text(self) -> SavedText:
        """What is in the file now. Raises ConsoleFileError if it cannot be read."""
        path = self.path if self.path.exists() else self._example
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ConsoleFileError(str(path), [Problem("", f"cannot be read: {error}")]) from error
        return SavedText(text, revision_of(text))

    def layout(self) -> WizardLayout:
        """What the page is made of. Raises ConsoleFileError with all that is wrong."""
        return read_layout(self.text().text, self.path.name)

    def save(self, text: str, revision: str | None) -> SavedText:
        """Write a text that can be read as a layout.

        Args:
            text: YAML.
            revision: Of the text that it was made from; None: whatever is there is replaced.

        Raises:
            ConsoleFileError: It is no layout; the file stays as it is.
            EditConflict: The file is not the one that it was made from.
            FileTrouble: It cannot be written.
        """
        read_layout(text, self.path.name)
        if revision is not None and self.text().revision != revision:
            raise EditConflict(self.path)
        write_whole(self.path, text)
        return SavedText(text, revision_of(text))


class CurrentLayout:
    """The layout that pages show: the newest of the file that could be read. Any thread.

    Attributes:
        layout: Empty before a file could be read.
        problems: What is wrong with the file as it is now; `layout` is then that of before.
    """

    def __init__(self, file: LayoutFile) -> None:
        """Read the file."""
        self.layout = WizardLayout()
        self.problems: Sequence[Problem] = ()
        self._file = file
        self._lock, self._looking = threading.Lock(), threading.Lock()  # nobody waits for the file with the first
        self._mark: tuple[int, int] | None = None
        self._listeners: dict[object, Callable[[], None]] = {}
        self.look()

    def look(self) -> None:
        """Read the file again if it has changed, and tell pages of that. Not for the event loop."""
        with self._looking:
            mark = self._file.mark
            if mark == self._mark:
                return
            self._mark = mark
            try:
                self.layout, self.problems = self._file.layout(), ()
            except ConsoleFileError as error:
                self.problems = error.problems
        with self._lock:
            listeners = list(self._listeners.values())
        for listener in listeners:
            listener()

    def subscribe(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Have changes told, in the thread that learns of them; what comes back ends that."""
        key = object()
        with self._lock:
            self._listeners[key] = callback
        return lambda: self._forget(key)

    def _forget(self, key: object) -> None:
        with self._lock:
            self._listeners.pop(key, None)
