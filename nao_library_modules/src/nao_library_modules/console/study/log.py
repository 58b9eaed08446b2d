"""The log of a trial: a JSON object a line. Pure.

What is added is with the operating system at once, where the end of the process takes nothing, and on the disk within
`DELAY`, where that of the computer takes nothing.
"""

from __future__ import annotations

import csv
import fcntl
import io
import json
import math
import os
import threading
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ...base.whole_file import write_whole
from .errors import StudyError

EVENTS, TABLE = "events.jsonl", "events.csv"
DELAY = 0.2
"""s from an event to the disk, at most; those that come meanwhile go there together."""
COLUMNS = ("n", "stamp", "wall", "kind", "robot", "by", "text", "data")
FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What a cell begins with that spreadsheets take for a formula."""


class TrialLog:
    """Writes the log of a trial, from any thread.

    Opened again it goes on behind the last whole line. Raises StudyError if another process writes it, or it cannot be
    written.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / EVENTS
        self._lock = threading.Lock()
        self._dirty, self._closing = threading.Event(), threading.Event()
        self.trouble = ""
        """Why what was added last is not on the disk; empty if it is, or will be."""
        try:
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o666)
        except OSError as error:
            raise StudyError(f"{self._path} cannot be written: {error.strerror}") from error
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            os.close(self._file)
            raise StudyError(f"{folder.name} is run by another program at this moment") from error
        whole, self._count = _whole_part(self._path)
        os.ftruncate(self._file, whole)
        _sync_folder(folder)
        self._thread = threading.Thread(target=self._sync, name="study log", daemon=True)
        self._thread.start()

    def add(self, event: Mapping[str, Any]) -> dict[str, Any]:
        """Add an event, JSON values; a number `n` and the time of this computer are added. Returns what is logged."""
        with self._lock:
            if self._file < 0:
                return dict(event)
            self._count += 1
            logged = {"n": self._count, "wall": round(time.time(), 3), **_finite(event)}
            line = json.dumps(logged, ensure_ascii=False, default=str).encode(errors="replace") + b"\n"
            length = os.fstat(self._file).st_size
            try:
                while line:
                    line = line[os.write(self._file, line) :]
                self.trouble = ""
            except OSError as error:
                self.trouble = f"{self._path} cannot be written: {error.strerror or error}"
                os.ftruncate(self._file, length)  # half a line would spoil the next one
        self._dirty.set()
        return logged

    def close(self) -> None:
        """Put all of it on the disk. What is added later is lost."""
        if not self._closing.is_set():
            self._closing.set()
            self._dirty.set()
            self._thread.join()
            self._put()
            with self._lock:
                os.close(self._file)
                self._file = -1

    def _sync(self) -> None:
        while not self._closing.is_set():
            self._dirty.wait()
            self._closing.wait(DELAY)
            self._dirty.clear()
            self._put()

    def _put(self) -> None:
        try:
            os.fsync(self._file)
        except OSError as error:
            self.trouble = f"{self._path} cannot be put on the disk: {error.strerror or error}"


def is_written(folder: Path) -> bool:
    """Whether a program has the log of a trial open for writing."""
    try:
        file = os.open(folder / EVENTS, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return True
    finally:
        os.close(file)
    return False


def read_events(folder: Path) -> list[dict[str, Any]]:
    """Events of a trial. A line that was cut short at the end is left out, as is one that is damaged."""
    path = folder / EVENTS
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return []
    except OSError as error:
        raise StudyError(f"{path} cannot be read: {error.strerror}") from error
    events = []
    for line in content.split(b"\n")[:-1]:
        try:
            event = json.loads(line)
        except ValueError:
            continue
        if isinstance(event, dict):
            events.append(event)
    return events


def write_events_table(folder: Path) -> Path:
    """Write the events of a trial as CSV; where that is."""
    rows = [
        [json.dumps(event.get(name, {}), ensure_ascii=False) if name == "data" else event.get(name) for name in COLUMNS]
        for event in read_events(folder)
    ]
    return write_whole(folder / TABLE, csv_text(COLUMNS, rows))


def csv_text(columns: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A table as CSV (RFC 4180, lines end with CR LF); no text of it is taken for a formula by a spreadsheet."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow([guarded(column) for column in columns])
    writer.writerows([guarded(cell) for cell in row] for row in rows)
    return text.getvalue()


def guarded(cell: Any) -> Any:
    """A cell of a table; a text that begins as a formula has an apostrophe before it. Numbers stay, as does nothing."""
    if isinstance(cell, str) and cell.startswith(FORMULA):
        return f"'{cell}"
    return "" if cell is None else cell


def _whole_part(path: Path) -> tuple[int, int]:
    """Bytes of the whole lines of a file, and the number of its last event."""
    content = path.read_bytes()
    whole = content.rfind(b"\n") + 1
    numbers = [0]
    for line in content[:whole].splitlines()[-2:]:
        try:
            numbers.append(int(json.loads(line)["n"]))
        except (ValueError, KeyError, TypeError):
            numbers.append(content[:whole].count(b"\n"))
    return whole, max(numbers)


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): _finite(entry) for name, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _sync_folder(folder: Path) -> None:
    """Have the name of the log on the disk as well."""
    for each in (folder, folder.parent):
        descriptor = os.open(each, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
