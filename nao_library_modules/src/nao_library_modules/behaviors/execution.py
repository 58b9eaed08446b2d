"""Runs a program on the plan language: goals for servers, in order, at once, on timelines, and what to do on failures.

Every step that waits does so in the plan, so that the end of the plan ends all of them at once, and a goal that runs is
cancelled and seen to its end. On a timeline each entry is a branch that waits for its time. `RunReport` keeps what
became of the steps, and tells it while it happens.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Callable

from actionlib_msgs.msg import GoalStatus

from naoqi.errors import NaoError

from ..core.waiting import CancellationToken
from ..process_modules.control import do, par, pursue, top_level
from ..process_modules.failures import PlanFailure
from ..process_modules.fluents import Evaporated, Fluent, sleep, wait_until
from ..process_modules.tasks import current_task
from .behavior_errors import StepFailed
from .model import (
    BarrierNode,
    GoalNode,
    Node,
    OnTimeline,
    ParallelNode,
    PathParts,
    Pause,
    RaceNode,
    RepeatNode,
    name_of,
    servers_in,
    walk,
    walk_rounds,
)

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


# --- timelines --------------------------------------------------------------------------------------------------------


class _Moments:
    """When an entry began and ended, s from the beginning of the behaviour; None until then."""

    def __init__(self, name: str) -> None:
        self.begun = Fluent(f"{name} began", None)
        self.over = Fluent(f"{name} ended", None)


class TimelineRun:
    """One run of a timeline.

    Args:
        report: Its clock counts.
        step: Runs a step: `step(node, due, begun)`.
        zero: When the timeline began, s from the beginning of the behaviour.
    """

    def __init__(self, node: OnTimeline, report: RunReport, step: Callable[..., Any], zero: float) -> None:
        self._entries = node.nodes
        self._report = report
        self._step = step
        self._zero = zero
        self._moments = [_Moments(each.what) for each in node.nodes]
        self._by_name = {name_of(each): m for each, m in zip(node.nodes, self._moments) if name_of(each)}

    def run(self) -> None:
        """Run all entries; over when the last one is."""
        par(*(do(self._entry, i, name=entry.what) for i, entry in enumerate(self._entries)))

    def _entry(self, i: int) -> None:
        entry, moments = self._entries[i], self._moments[i]
        due = self._due(i, entry)
        wait = due - self._report.now()
        if wait > 0.0:
            sleep(wait)
        self._let_go_first(i, entry)

        def begun() -> None:
            if moments.begun.value is None:
                moments.begun.value = self._report.now()

        self._step(entry, due, begun)
        begun()
        moments.over.value = self._report.now()

    def _due(self, i: int, entry: Node) -> float:
        """When an entry is to begin, s from the beginning of the behaviour; waits until that is known."""
        if isinstance(entry, BarrierNode):
            return max(self._known(moments.over) for moments in self._moments[:i])
        if not entry.at.label:
            return self._zero + entry.at.offset
        other = self._by_name[entry.at.label]
        return self._known(other.over if entry.at.of_end else other.begun) + entry.at.offset

    def _let_go_first(self, i: int, entry: Node) -> None:
        """Of entries at the same time that need the same server, those above go first."""
        servers = servers_in(entry)
        for other, moments in zip(self._entries[:i], self._moments):
            if other.at != entry.at or isinstance(other, BarrierNode):
                continue
            if not servers.keys().isdisjoint(servers_in(other)):
                self._known(moments.begun)

    @staticmethod
    def _known(moment: Fluent) -> float:
        wait_until(lambda: moment.value is not None, [moment])
        return float(moment.value)


# --- a run ------------------------------------------------------------------------------------------------------------

NOTED_LATE = 0.05
"""s after its time from which on it is told that a step is late."""

Clients = Callable[[str], Any]
"""Gives the client of a server, by its name: see `clients.ServerClient`."""


class Execution:
    """One run of a program.

    Attributes:
        report: What became of the steps; complete when `run` is over, however it ends.

    Args:
        tell: Gets everything that happens to steps.
    """

    def __init__(self, program: Node, clients: Clients, clock: Any, tell: Callable[[StepEvent], None]) -> None:
        self._program = program
        self._clients = {server: clients(server) for server in servers_in(program)}
        self._clock = clock
        self._turns = _FifoLock(self._clients)
        self._meetings: dict[PathParts, tuple[Node, Fluent]] = {}
        self.report = RunReport(clock, tell)

    def run(self, interrupt: CancellationToken) -> None:
        """Run it; a trigger of `interrupt` ends it.

        Raises:
            StepFailed: A step failed whose failure is to stop the behaviour.
            PlanFailure: A server is not there; or the interrupt ended it, which `interrupt.check` tells then.
        """
        try:
            top_level(do(self._all, interrupt, name=self._program.what), clock=self._clock)
        finally:
            self.report.close()

    def _all(self, interrupt: CancellationToken) -> None:
        root = current_task()
        with interrupt.waking(lambda: root.evaporate("preempted")):
            try:
                # All of them are there before anything moves.
                for client in self._clients.values():
                    client.wait_for_server()
                self._in_order(self._program)
            finally:
                for part in self._program.parts:
                    self.report.not_run(part)
                for part in self._program.parts:
                    self.report.rounds_not_run(part)

    # --- a step -------------------------------------------------------------------------------------------------------

    def _step(self, node: Node, due: float | None = None, begun: Callable[[], None] = lambda: None) -> None:
        """Run a step to its end, with the retries that it is allowed.

        `due`: when it was to begin, s from the beginning of the behaviour; now if there is no such time.
        """
        wanted = self.report.now() if due is None else due
        retries = node.policy.retries
        former: list[StepRecord] = []
        while True:
            record: list[StepRecord] = []

            def begin(record: list[StepRecord] = record) -> StepRecord:
                late = max(self.report.now() - wanted, 0.0)
                record.append(self.report.began(node, late))
                if late > NOTED_LATE and record[0].attempts == 1:
                    self.report.tell(node, LATE, f"{late:.3f} s late")
                begun()
                return record[0]

            try:
                self._limited(node, begin)
            except (PlanFailure, NaoError) as failure:
                own = isinstance(failure, StepFailed) and failure.details["path"] == node.where
                error = failure.details["problem"] if own else str(failure)
                record = record or [self.report.began(node)]
                if retries > 0:
                    retries -= 1
                    self.report.tell(node, RETRIED, error)
                    former = record
                    continue
                self.report.ended(record[0], SKIPPED if node.policy.skip else FAILED, error)
                if node.policy.skip:
                    return
                if isinstance(failure, StepFailed):
                    raise
                raise StepFailed(node.where, node.what, error, node.file, node.line) from failure
            except Evaporated:
                # A step that is to be tried again may be waiting for its server: it has begun before.
                for begun_before in record or former:
                    self.report.ended(begun_before, PREEMPTED)
                raise
            self.report.ended(record[0], ENDED)
            return

    def _limited(self, node: Node, begin: Callable[[], StepRecord]) -> None:
        if node.limit is None:
            self._do(node, begin)
            return
        # The time of a step begins with the step, not while it waits for its server.
        started = Fluent(f"{node.what} began", False)

        def begin_and_note() -> StepRecord:
            record = begin()
            started.value = True
            return record

        def watch(limit: float = node.limit) -> None:
            wait_until(lambda: started.value, [started])
            sleep(limit)

        pursue(do(self._do, node, begin_and_note, name=node.what), do(watch, name=f"for {node.limit:g} s"))

    def _do(self, node: Node, begin: Callable[[], StepRecord]) -> None:
        if isinstance(node, GoalNode):
            self._goal(node, begin)
            return
        record = begin()
        if isinstance(node, Pause):
            sleep(node.duration)
        elif isinstance(node, BarrierNode):
            self._meet(node)
        elif isinstance(node, OnTimeline):
            TimelineRun(node, self.report, self._step, record.tried).run()
        elif isinstance(node, ParallelNode):
            self._at_once(node)
        elif isinstance(node, RepeatNode):
            for number in range(1, node.count + 1):
                self._in_order(node.round(number))
        else:
            self._in_order(node)

    # --- kinds --------------------------------------------------------------------------------------------------------

    def _goal(self, node: GoalNode, begin: Callable[[], StepRecord]) -> None:
        with self._turns.of(node.server, self.report.now(), node.path):
            record = begin()
            told: list[str] = []

            def on_feedback(feedback: Any) -> None:
                text = _news(feedback)
                if text and text not in told[-1:]:
                    told.append(text)
                    self.report.tell(node, TOLD, text)

            def on_end(end: Any) -> None:
                # Also of a goal that was cancelled: what it did until then counts.
                if end.result is not None:
                    record.results = list(end.result.results)

            end = self._clients[node.server].call(node.goal, on_feedback=on_feedback, on_end=on_end)
            if not end.succeeded:
                # The behaviour itself cancels goals only where it does not look at their ends any more.
                why = ": a goal of somebody else took its place" if end.status == GoalStatus.PREEMPTED else ""
                raise StepFailed(node.where, node.what, f"{end}{why}", node.file, node.line)

    def _in_order(self, node: Node) -> None:
        parts = node.parts
        for i, part in enumerate(parts):
            try:
                self._step(part)
            except BaseException:
                for other in parts[i + 1 :]:
                    self.report.not_run(other)
                raise

    def _at_once(self, node: ParallelNode) -> None:
        met = Fluent(f"met in {node.where}", frozenset())
        self._meetings[node.path] = (node, met)
        branches = []
        for number, part in enumerate(node.nodes, start=1):

            def branch(part: Node = part, number: int = number) -> None:
                self._step(part)
                # Whoever waits at a barrier waits for this branch no longer.
                met.update(lambda there: there | {(number, "")})

            branches.append(do(branch, name=part.what))
        if isinstance(node, RaceNode):
            pursue(*branches)
        else:
            par(*branches)

    def _meet(self, node: BarrierNode) -> None:
        if node.home is None:
            return  # a barrier of a timeline has waited for its time, and that was all
        home, met = self._meetings[node.home]
        met.update(lambda there: there | {(node.branch, node.name)})
        expected = {
            number
            for number, branch in enumerate(home.parts, start=1)
            if any(isinstance(e, BarrierNode) and e.home == node.home and e.name == node.name for e in walk(branch))
        }
        wait_until(lambda: all((n, node.name) in met.value or (n, "") in met.value for n in expected), [met])


def _news(feedback: Any) -> str:
    """What a server tells while it carries out a goal, beyond that a single function runs."""
    parts = []
    if getattr(feedback, "waiting", ""):
        parts.append(f"waits for {feedback.waiting}")
    elif getattr(feedback, "count", 0) > 1:
        parts.append(f"function {feedback.index + 1} of {feedback.count}: {feedback.function}")
    parts += [str(getattr(feedback, name)) for name in ("status", "word") if getattr(feedback, name, "")]
    return ", ".join(parts)


class _FifoLock:
    """A turn with each of several servers, which run one goal at a time: a further one would end the first.

    Who came first is first, at the same time by the order of the file.
    """

    def __init__(self, servers: Iterable[str]) -> None:
        # (ticket of who has the turn or None, tickets of who waits)
        self._queues = {server: Fluent(f"turn with {server}", (None, ())) for server in servers}

    @contextmanager
    def of(self, server: str, now: float, path: PathParts) -> Iterator[None]:
        """Have the turn with a server in a block; waits for it, in a plan. `now`: time of asking, s."""
        queue = self._queues[server]
        ticket = (now, tuple(number for _, number in path), object())

        def take(state: Any) -> Any:
            holder, waiting = state
            if holder is None and min(waiting, key=lambda each: each[:2]) is ticket:
                return ticket, tuple(each for each in waiting if each is not ticket)
            return state

        def leave(state: Any) -> Any:
            holder, waiting = state
            return None if holder is ticket else holder, tuple(each for each in waiting if each is not ticket)

        queue.update(lambda state: (state[0], (*state[1], ticket)))
        try:
            wait_until(lambda: queue.update(take)[0] is ticket, [queue])
            yield
        finally:
            queue.update(leave)
