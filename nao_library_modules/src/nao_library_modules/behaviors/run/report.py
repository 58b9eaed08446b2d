"""What became of the steps of a behaviour that runs: kept for the result, and told while it happens."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Callable

from ..language.model import PathParts
from ..language.program import Node, RepeatNode, walk, walk_rounds

BEGAN, ENDED, FAILED, SKIPPED, PREEMPTED = "began", "ended", "failed", "skipped", "preempted"
RETRIED, LATE, TOLD, NOT_RUN = "retried", "late", "told", "not run"

MOST_RECORDS = 20_000
"""Steps that a result lists: of repetitions that go on for hours the last rounds are only counted."""
MOST_NOT_RUN = 1_000
"""Steps of later rounds that a result lists as not run, of each repetition: `repeat: 10000` is no rare thing."""


@dataclass
class StepRecord:
    """What became of one step; times in s from the beginning of the behaviour, -1 if there is none.

    Attributes:
        state: "ended", "failed", "skipped", "preempted" or "not run"; "began" while it runs.
        began: When it began, the first time.
        tried: When its last attempt began.
        ended: When it ended, the last time.
        late: s that it began after its time.
        attempts: How often it was tried.
        results: What its functions answered; FunctionResult messages of the last attempt.
    """

    node: Node
    state: str = NOT_RUN
    began: float = -1.0
    tried: float = -1.0
    ended: float = -1.0
    late: float = 0.0
    attempts: int = 0
    error: str = ""
    results: list[Any] = field(default_factory=list)


@dataclass(frozen=True)
class StepEvent:
    """Something that happened to a step."""

    node: Node
    state: str  # one of the constants of this module
    time: float  # s from the beginning of the behaviour
    text: str = ""  # why, by how much, or what its server told


class RunReport:
    """Keeps the records of one run. Branches write from threads of their own; the lock is held for bookkeeping only.

    `clock`: whose time it has. `tell`: gets every event, one after the other.
    """

    def __init__(self, clock: Any, tell: Callable[[StepEvent], None]) -> None:
        self._clock = clock
        self._tell = tell
        self._records: dict[PathParts, StepRecord] = {}
        self._lock = threading.Lock()
        self._telling = threading.Lock()
        self._closed = False
        self._zero = clock.now()

    def now(self) -> float:
        """Time from the beginning of the behaviour, s."""
        return self._clock.now() - self._zero

    def began(self, node: Node, late: float = 0.0) -> StepRecord:
        """A step begins, perhaps once more. `late`: s that it begins after its time."""
        now = self.now()
        with self._lock:
            record = self._records.get(node.path)
            if record is None:
                record = StepRecord(node)
                if len(self._records) < MOST_RECORDS:
                    self._records[node.path] = record
            if record.began < 0.0:
                record.began, record.late = now, late
            record.tried = now
            record.state, record.error, record.results = BEGAN, "", []
            record.attempts += 1
        self.tell(node, BEGAN)
        return record

    def ended(self, record: StepRecord, state: str, error: str = "") -> None:
        """A step is over."""
        with self._lock:
            record.state, record.error, record.ended = state, error, self.now()
        self.tell(record.node, state, error)

    def not_run(self, node: Node) -> None:
        """A step, and all inside of it, will not begin any more."""
        with self._lock:
            for each in walk(node):
                if len(self._records) < MOST_RECORDS:
                    self._records.setdefault(each.path, StepRecord(each))

    def rounds_not_run(self, node: Node) -> None:
        """The behaviour is over: rounds of repetitions in this step did not begin, but for those that did."""
        with self._lock:
            for each in _outermost_rounds(node):
                self._list_rounds(each)

    def _list_rounds(self, repetition: RepeatNode) -> None:
        listed = 0
        for each in walk_rounds(repetition, self._had_enough):
            if each.path in self._records:
                continue
            if listed >= MOST_NOT_RUN or len(self._records) >= MOST_RECORDS:
                return
            self._records[each.path] = StepRecord(each)
            listed += 1

    def _had_enough(self, path: PathParts) -> bool:
        """Whether a repetition is done although rounds are left: by its own limit, or by that of a step around it."""
        for end in range(len(path), 0, -1):
            record = self._records.get(path[:end])
            if record is not None and record.state not in (PREEMPTED, NOT_RUN):
                return record.state == ENDED
        return False

    def tell(self, node: Node, state: str, text: str = "") -> None:
        """Tell of something that happened."""
        with self._telling:
            if not self._closed:
                self._tell(StepEvent(node, state, self.now(), text))

    def close(self) -> None:
        """Tell nothing any more: feedback of a server may come when its goal is over and another one runs."""
        with self._telling:
            self._closed = True

    def records(self) -> list[StepRecord]:
        """All records, in the order of the file."""
        with self._lock:
            return sorted(self._records.values(), key=lambda record: [number for _, number in record.node.path])


def _outermost_rounds(node: Node) -> Iterator[RepeatNode]:
    """Repetitions that are in no other one."""
    if isinstance(node, RepeatNode):
        yield node
        return
    for part in node.parts:
        yield from _outermost_rounds(part)
