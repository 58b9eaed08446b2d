"""The log of a trial: a JSON object a line. Pure.

What is added is with the operating system at once, where the end of the process takes nothing, and on the disk within
`DELAY`, where that of the computer takes nothing.
"""

from __future__ import annotations

import csv
import fcntl
import io
import json
import logging
import math
import os
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...base.whole_file import FileTrouble, sync_folder, write_whole
from .errors import StudyError

log = logging.getLogger(__name__)

EVENTS, TABLE = "events.jsonl", "events.csv"
DELAY = 0.2
"""s from an event to the disk, at most; those that come meanwhile go there together. Also s between two tries."""
PATIENCE = 30.0
"""s for which the disk of a log that is closed may be full."""
COLUMNS = ("n", "stamp", "wall", "kind", "robot", "by", "text", "data")
FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What a cell begins with that spreadsheets take for a formula."""


@dataclass(frozen=True)
class LogGap:
    """A time in which the log could not be written. Its events waited in memory and were written when it was over."""

    began: float  # time of this computer, s
    ended: float
    events: int
    reason: str
    stamp: float | None  # of the first event that waited; None: not known


class TrialLog:
    """Writes the log of a trial, from any thread.

    What the disk does not take waits in memory, and is written first, in its order, when there is room again. A place
    of the file is written until a sync has succeeded behind it: neither half a line nor a failed sync spoils the log.
    Opened again it continues behind the last whole line.

    Attributes:
        on_change: Called in a thread of the log: with None when it cannot be written, with the gap when it could be
            written again.

    Raises:
        StudyError: Another process writes it, or it cannot be opened.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / EVENTS
        self._lock = threading.Lock()
        self._dirty, self._closing, self._given_up = threading.Event(), threading.Event(), threading.Event()
        self.on_change: Callable[[LogGap | None], None] = lambda _: None
        try:
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        except OSError as error:
            raise StudyError(f"{self._path} cannot be written: {error.strerror}") from error
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            os.close(self._file)
            raise StudyError(f"{folder.name} is run by another program at this moment") from error
        self._synced, self._count = _whole_part(self._path)
        """Bytes that are on the disk; number of the last event."""
        self._pending = bytearray()  # what comes behind them
        self._written = 0  # bytes of it that the operating system has
        self._gap: tuple[float, float, str] | None = None  # begin of this computer and monotonic, reason
        self._gap_events, self._gap_stamp = 0, None
        try:
            os.ftruncate(self._file, self._synced)
            sync_folder(folder)
            sync_folder(folder.parent)
        except OSError as error:
            os.close(self._file)
            raise StudyError(str(FileTrouble(self._path, error))) from error
        self._thread = threading.Thread(target=self._keep_writing, name="study log", daemon=True)
        self._thread.start()

    @property
    def trouble(self) -> str:
        """Why events are not on the disk, and how many wait; empty if all are, or will be within `DELAY`."""
        with self._lock:
            if self._gap is None:
                return ""
            since = time.strftime("%H:%M:%S", time.localtime(self._gap[0]))
            return f"{self._gap[2]}; {self._waiting()} events wait in memory since {since}: make room"

    @property
    def blocked_for(self) -> float:
        """How long it has not been possible to write, s of this computer; 0: it is possible."""
        with self._lock:
            return 0.0 if self._gap is None else time.monotonic() - self._gap[1]

    def add(self, event: Mapping[str, Any]) -> dict[str, Any]:
        """Add an event, JSON values; a number `n` and the time of this computer are added. Returns what is logged."""
        with self._lock:
            if self._file < 0:
                return dict(event)
            self._count += 1
            logged = {"n": self._count, "wall": round(time.time(), 3), **_finite(event)}
            self._pending += json.dumps(logged, ensure_ascii=False, default=str).encode(errors="replace") + b"\n"
            in_gap = self._gap is not None
            try:
                self._write()
            except OSError as error:
                self._fail(error)
                if not in_gap:
                    self._gap_stamp = event.get("stamp")
            self._gap_events += in_gap and self._waiting() > 0
        self._dirty.set()
        return logged

    def close(self, patience: float = PATIENCE) -> int:
        """Put all of it on the disk. What is added later is lost.

        `patience`: s for which it is tried. Returns how many events are not on the disk, and lost.
        """
        if not self._closing.is_set():
            self._closing.set()
            self._dirty.set()
            self._thread.join(patience)
            self._given_up.set()
            self._thread.join()
            self._put()
            with self._lock:
                os.close(self._file)
                self._file, self._gap = -1, None
        with self._lock:
            return self._pending.count(b"\n")

    def _keep_writing(self) -> None:
        """Put on the disk what is added, and what waits, until it is closed."""
        failed = False
        while not self._given_up.is_set():
            self._dirty.wait()
            (self._given_up if failed else self._closing).wait(DELAY)
            self._dirty.clear()
            whole, gap = self._put()
            if gap is not None or not (whole or failed):
                self._tell(gap)
            failed = not whole
            if failed:
                self._dirty.set()
            elif self._closing.is_set() and not self._dirty.is_set():
                return

    def _tell(self, gap: LogGap | None) -> None:
        try:
            self.on_change(gap)
        except Exception:  # whatever it is: the log has to be written
            log.exception("a change of %s is not told", self._path)

    def _put(self) -> tuple[bool, LogGap | None]:
        """Write and sync; whether all is on the disk that had been added, and the gap that is over with it."""
        with self._lock:
            try:
                self._write()
            except OSError as error:
                self._fail(error)
                return False, None
            written = self._written
        try:
            os.fsync(self._file)
        except OSError as error:
            with self._lock:
                self._written = 0  # whether the operating system still has any of it, nobody knows
                self._fail(error)
            return False, None
        with self._lock:
            del self._pending[:written]
            self._synced += written
            self._written -= written
            if self._gap is None or self._written < len(self._pending):
                return True, None
            began, _, reason = self._gap
            gap = LogGap(began, time.time(), self._gap_events, reason, self._gap_stamp)
            self._gap, self._gap_events, self._gap_stamp = None, 0, None
            return True, gap

    def _write(self) -> None:
        """Give the operating system what it does not have. Called with the lock."""
        while self._written < len(self._pending):
            waiting = bytes(self._pending[self._written :])
            self._written += os.pwrite(self._file, waiting, self._synced + self._written)

    def _fail(self, error: OSError) -> None:
        """Note that it cannot be written. Called with the lock."""
        reason = str(FileTrouble(self._path, error))
        if self._gap is None:
            self._gap, self._gap_events = (time.time(), time.monotonic(), reason), self._waiting()

    def _waiting(self) -> int:
        """Events that the operating system does not have whole. Called with the lock."""
        return self._pending.count(b"\n", self._written)


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
        except (ValueError, RecursionError):
            continue
        if isinstance(event, dict):
            events.append(event)
    return events


def write_events_table(folder: Path, patience: float = 0.0) -> Path:
    """Write the events of a trial as CSV; where that is.

    `patience`: s for which the disk may be full. Raises FileTrouble.
    """
    rows = [
        [json.dumps(event.get(name, {}), ensure_ascii=False) if name == "data" else event.get(name) for name in COLUMNS]
        for event in read_events(folder)
    ]
    end = time.monotonic() + patience
    while True:
        try:
            return write_whole(folder / TABLE, csv_text(COLUMNS, rows))
        except FileTrouble:
            if time.monotonic() >= end:
                raise
            time.sleep(DELAY)


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
        except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
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
