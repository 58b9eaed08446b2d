"""Runs a program on the plan language: goals for servers, in order, at once, on timelines, and what to do on failures.

Every step that waits does so in the plan, so that the end of the plan ends all of them at once, and a goal that runs is
cancelled and seen to its end.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Callable

from actionlib_msgs.msg import GoalStatus

from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...process_modules.language.control import do, par, pursue, top_level
from ...process_modules.language.failures import PlanFailure
from ...process_modules.language.flow import Evaporated, sleep, wait_until
from ...process_modules.language.fluents import Fluent
from ...process_modules.language.tasks import current_task
from ..language.errors import StepFailed
from ..language.model import PathParts
from ..language.program import (
    BarrierNode,
    GoalNode,
    Node,
    OnTimeline,
    ParallelNode,
    Pause,
    RaceNode,
    RepeatNode,
    servers_in,
    walk,
)
from .report import ENDED, FAILED, LATE, PREEMPTED, RETRIED, SKIPPED, TOLD, RunReport, StepEvent, StepRecord
from .timeline import TimelineRun

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
