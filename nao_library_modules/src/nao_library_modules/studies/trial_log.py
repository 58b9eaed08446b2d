"""The log of a trial, a JSON object a line, and the state of the trial, which follows from its events alone.

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
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ..core.files import FileTrouble, sync_folder, write_whole
from .protocol import DONE, NOTHING, StudyError
from .robot_events import ALARM, STATE, ConsoleEvent
from .schedule import is_inside

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


TRIAL = "trial"
"""Kind of the events that a trial itself adds; their `data` has what as one of those below."""
BEGAN, RESUMED, STEP_BEGAN, STEP_ENDED, PAUSED, CONTINUED, HELD, ENDED = (
    *("began", "resumed", "step began", "step ended", "paused", "continued", "held", "ended"),
)
TROUBLE_SEEN = "trouble seen"
LOG_GAP = "log gap"
"""What a deviation has as `what` that tells when the log could not be written."""
CORRECTED, TAKEN_BACK = "pseudonym corrected", "participant taken back"
RECORDING_BEGAN, RECORDING_ENDED = "recording began", "recording ended"
RUNNING, INTERRUPTED, FINISHED, ABORTED = "running", "interrupted", "finished", "aborted"
STATES = (RUNNING, PAUSED, HELD, INTERRUPTED, FINISHED, ABORTED)
TIMEOUT, SKIPPED, FAILED, REPEATED, STOPPED = "timeout", "skipped", "failed", "repeated", "stopped"
CUT = "cut"
"""End of a step in a `while` that has ended it."""
ON = (DONE, TIMEOUT, SKIPPED, FAILED)
"""Ends of a step behind which the next one comes; a failed one where the protocol says so, or the wizard goes on."""


@dataclass
class StepOutcome:
    """A step that was begun. Times are ROS times, s."""

    path: str
    phase: str
    label: str
    kind: str
    text: str
    attempt: int  # how often it has been begun
    began: float | None  # None: the log does not tell
    ended: float | None = None  # None: it has not
    outcome: str = ""  # done, timeout, skipped, failed, repeated, stopped, cut; empty: it has not ended
    answer: str = ""  # choice, sensor, word, name of the face
    seconds: float | None = None  # reaction time: from `began` to the answer
    error: str = ""
    finished: float | None = None  # when what the robot did was over, of speech the last sound; None: it does not tell
    rounds: Mapping[str, int] = field(default_factory=dict)  # name of a loop's value -> value, from outside
    note_texts: list[str] = field(default_factory=list)  # written before the next step began
    deviation_texts: list[str] = field(default_factory=list)


@dataclass
class TrialState:
    """How far a trial is."""

    about: dict[str, Any] = field(default_factory=dict)  # what the event of its begin holds
    status: str = ""  # one of `STATES`; empty: it has not begun
    path: str = ""  # of the last step that is over, empty: none is
    values: dict[str, Any] = field(default_factory=dict)  # for conditions and texts
    outcomes: list[StepOutcome] = field(default_factory=list)
    recordings: dict[str, dict[str, Any]] = field(default_factory=dict)  # kind -> what runs
    files: list[dict[str, Any]] = field(default_factory=list)  # recordings that have ended
    began: float = 0.0
    ended: float | None = None
    note_texts: list[str] = field(default_factory=list)
    deviation_texts: list[str] = field(default_factory=list)  # gaps among them
    alarms: list[str] = field(default_factory=list)  # those that began in the trial, for people
    robot: dict[str, Any] = field(default_factory=dict)  # how it was at the begin; empty: the log does not tell
    gaps: list[str] = field(default_factory=list)  # what the log lacks
    taken_back: bool = False  # its participant was, before a step began
    trouble: str = ""  # of the log, until somebody has seen it
    open: list[StepOutcome] = field(default_factory=list)  # steps that run: a `while`, and the one in it

    @staticmethod
    def of(events: Iterable[Mapping[str, Any]], runs: bool = False) -> TrialState:
        """Of a log. Without an end a trial is `INTERRUPTED`, unless it was paused or held, or a program `runs` it."""
        state, last = TrialState(), 0
        for event in events:
            number = event.get("n")
            if isinstance(number, int):
                if number > last + 1:
                    missing = f"event {last + 1} is" if number == last + 2 else f"events {last + 1} to {number - 1} are"
                    state._lacks(f"{missing} not in the log")
                last = number
            state.apply(event)
        if state.status == RUNNING and not runs:
            state.status = INTERRUPTED
        return state

    @property
    def over(self) -> bool:
        """Whether it is finished or aborted."""
        return self.status in (FINISHED, ABORTED)

    @property
    def rehearsal(self) -> bool:
        """Whether it only rehearses: it is none of the participant's trials."""
        return bool(self.about.get("rehearsal", False))

    @property
    def holds_number(self) -> bool:
        """Whether the number of its participant is used up by it: it is no rehearsal, and was not taken back."""
        return not self.rehearsal and not self.taken_back

    @property
    def counts(self) -> bool:
        """Whether summaries count it: it is neither aborted nor a rehearsal."""
        return self.status != ABORTED and not self.rehearsal

    @property
    def status_text(self) -> str:
        """Its status, and whether it is a rehearsal, for people."""
        return f"{self.status or 'empty'}{', rehearsal' if self.rehearsal else ''}"

    @property
    def steps_text(self) -> str:
        """How many steps were begun, which are its rows in the table, and how they ended, for people."""
        ends = Counter(outcome.outcome or "not ended" for outcome in self.outcomes)
        told = ", ".join(f"{count} {end}" for end, count in ends.items())
        return f"{len(self.outcomes)} step{'' if len(self.outcomes) == 1 else 's'}" + (f": {told}" if told else "")

    @property
    def notes(self) -> int:
        return len(self.note_texts)

    @property
    def deviations(self) -> int:
        return len(self.deviation_texts)

    @property
    def current(self) -> StepOutcome | None:
        """The step that was begun and has not ended; of a `while` and the step in it the `while`."""
        return self.open[0] if self.open else None

    @property
    def last(self) -> StepOutcome | None:
        """The step that was begun last, but for those in a `while`."""
        return next((each for each in reversed(self.outcomes) if not is_inside(each.path)), None)

    def attempts(self, path: str) -> int:
        """How often a step has been begun."""
        return sum(outcome.path == path for outcome in self.outcomes)

    def apply(self, event: Mapping[str, Any]) -> None:
        """Take an event into account; `event`: as it is logged."""
        kind, stamp, told = event.get("kind"), float(event.get("stamp") or 0.0), event.get("data") or {}
        what = told.get("what")
        if kind == ALARM and what == BEGAN:
            self.alarms.append(str(event.get("text", "")))
        if kind == STATE and not self.robot:
            self.robot = dict(told)
        if kind == "note":
            self._mark(str(event.get("text", "")), lambda of: of.note_texts)
        elif kind == "deviation":
            self._mark(str(event.get("text", "")), lambda of: of.deviation_texts)
        if kind == "deviation" and what == LOG_GAP:
            self.trouble = str(event.get("text", ""))
        if kind != TRIAL or not isinstance(what, str):
            return
        if what == BEGAN:
            self.about, self.values, self.began, self.status = dict(told), dict(told["values"]), stamp, RUNNING
        elif what in (PAUSED, HELD):
            self.status = what
        elif what in (CONTINUED, RESUMED):
            self.status = RUNNING
            for outcome in reversed(self.open[:] if what == RESUMED else []):
                self._end(outcome, {"outcome": STOPPED, "error": "the console was gone"}, stamp)
        elif what == STEP_BEGAN:
            self._lacks_end(told["path"])
            self.outcomes.append(_outcome(told, began=stamp))
            self.open.append(self.outcomes[-1])
        elif what == STEP_ENDED:
            self._end(self._begun(told), told, stamp)
        elif what == CORRECTED:
            self.about.update(participant=told["participant"], trial=told["corrected"])
            self.values["participant"] = told["participant"]
        elif what == TAKEN_BACK:
            self.taken_back = True
        elif what == TROUBLE_SEEN:
            self.trouble = ""
        elif what == RECORDING_BEGAN:
            self.recordings[told["recording"]] = dict(told)
        elif what == RECORDING_ENDED:
            self.files.append({**self.recordings.pop(told["recording"], {}), **told})
        elif what == ENDED:
            if told["outcome"] == FINISHED:
                self._lacks_end()
            self.status, self.ended = told["outcome"], stamp

    def _begun(self, told: Mapping[str, Any]) -> StepOutcome:
        """The step that an event of an end is about; one is added where the log lacks its begin."""
        place = (told["path"], told.get("attempt", 1))
        for outcome in reversed(self.outcomes):
            if (outcome.path, outcome.attempt) == place and outcome.ended is None:
                return outcome
        self._lacks_end(place[0])
        lacking = self._lacks(f"the begin of step {place[0]} is not in the log")
        self.outcomes.append(_outcome(told, began=None, error=lacking))
        return self.outcomes[-1]

    def _end(self, outcome: StepOutcome, told: Mapping[str, Any], stamp: float) -> None:
        if any(each is outcome for each in self.open):
            while self.open.pop() is not outcome:  # a step in it
                continue
        outcome.ended, outcome.outcome = stamp, told["outcome"]
        outcome.answer, outcome.seconds = told.get("answer", ""), told.get("seconds")
        outcome.finished = told.get("finished")
        outcome.error = "; ".join(filter(None, (outcome.error, told.get("error", ""))))
        if outcome.outcome in ON:
            if not is_inside(outcome.path):
                self.path = outcome.path
            if outcome.label:
                self.values[outcome.label] = outcome.answer or (NOTHING if outcome.outcome != DONE else DONE)
                self.values[f"{outcome.label}_seconds"] = outcome.seconds

    def _lacks_end(self, path: str = "") -> None:
        """Note of which steps the log does not tell the end: those that run, but for a `while` around `path`."""
        while self.open and not path.startswith(f"{self.open[-1].path}.w"):
            self._lacks_end_of(self.open.pop())

    def _lacks_end_of(self, outcome: StepOutcome) -> None:
        outcome.error = self._lacks(f"the end of step {outcome.path} is not in the log")

    def _lacks(self, what: str) -> str:
        """Note what the log lacks, a deviation; `what`."""
        self.gaps.append(what)
        self.deviation_texts.append(what)
        return what

    def _mark(self, text: str, texts_of: Callable[[TrialState | StepOutcome], list[str]]) -> None:
        """Keep the text of a note or a deviation, of the trial and of the step that was begun last."""
        texts_of(self).append(text)
        if self.outcomes:
            texts_of(self.outcomes[-1]).append(text)


def _outcome(told: Mapping[str, Any], began: float | None, error: str = "") -> StepOutcome:
    """A step, of the event of its begin or its end."""
    names = ("path", "phase", "label", "step", "title")
    rounds = told.get("rounds") or {}
    about = (told.get(name, "") for name in names)
    return StepOutcome(*about, told.get("attempt", 1), began, error=error, rounds=rounds)


class LeftTrial:
    """What its recordings need of it.

    Args:
        trial: Its id.
        trial_log: Opened.
        events: Of the log so far.
        robot: The `RobotClient`; None: there is none, and events have the time of the last one.
    """

    def __init__(self, trial: str, trial_log: TrialLog, events: Iterable[Mapping[str, Any]], robot: Any = None) -> None:
        known = list(events)
        self.id, self.robot = trial, robot
        self.state = TrialState.of(known)
        self._log = trial_log
        self._namespace = str(known[-1].get("robot", "")) if known else ""
        self._stamp = float(known[-1].get("stamp") or 0.0) if known else 0.0

    def tell(self, what: str, text: str, by: str = "", **more: Any) -> None:
        """Add an event of the trial; its state follows."""
        self._add(TRIAL, text, by, {**more, "trial": self.id, "what": what})

    def deviation(self, text: str, by: str = "") -> None:
        """Mark that something was not as the protocol has it."""
        self._add("deviation", text, by, {"trial": self.id, "path": self.state.path})

    def _add(self, kind: str, text: str, by: str, data: Mapping[str, Any]) -> None:
        stamp = self._stamp if self.robot is None else self.robot.now()
        self.state.apply(self._log.add(asdict(ConsoleEvent(stamp, kind, self._namespace, text, by, data))))
