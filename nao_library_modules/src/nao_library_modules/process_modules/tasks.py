"""Tasks: the nodes of a plan's tree, their states, and how they are ended, suspended and woken. Without ROS.

A task runs either in the thread of its parent (a step of a sequence, a plan that calls another one) or in a thread of
its own (a branch of `par`). States are CRAM's: created, running, suspended, succeeded, failed, evaporated.

Ending a task (`evaporate`) raises a signal in it at the next point where it waits or begins another task; clean-up
(`finally`) may wait once more inside `uninterrupted()`.
"""

from __future__ import annotations

import enum
import itertools
import threading
from collections.abc import Callable, Iterator
from typing import Any

from ..core.errors import of_those
from .failures import PlanError, PlanFailure, TaskEvaporatedFailure
from .fluents import Evaporated, Flow, Fluent, here, set_here


class TaskState(enum.Enum):
    CREATED = "created"
    RUNNING = "running"
    SUSPENDED = "suspended"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    EVAPORATED = "evaporated"

    @property
    def over(self) -> bool:
        return self in OVER


OVER = frozenset({TaskState.SUCCEEDED, TaskState.FAILED, TaskState.EVAPORATED})


class Task:
    """A piece of a plan.

    Attributes:
        reason: Why it was evaporated or last suspended.
        created: s of the tree's clock, as `began` and `ended`, which are None until then.
        ending: Rank in the order of ends in the tree, None until then: two may end at the same time.
        facts: For the trace, by name: arguments, designators, ...
        scope: Variables of constructs for the tasks below, by name.
        evaporating: Whether it is to end.
    """

    def __init__(self, name: str, body: Callable[[], Any], parent: Task | None, tree: Any = None) -> None:
        self.name = name
        self.parent = parent
        self.tree = tree if parent is None else parent.tree
        self.children: tuple[Task, ...] = ()
        self.status = Fluent(f"status of {name}", TaskState.CREATED)
        self.result: Any = None
        self.failure: BaseException | None = None
        self.reason = ""
        self.created = self.tree.clock.now()
        self.began: float | None = None
        self.ended: float | None = None
        self.ending: int | None = None
        self.facts: dict[str, Any] = {}
        self.scope: dict[str, Any] = {}
        self._body = body
        self._flow: Flow | None = None
        self._thread: threading.Thread | None = None
        self.evaporating = False
        self._suspensions = 0
        with self.tree.lock:
            self.number = next(self.tree.numbers)
            if parent is not None:
                parent.children = (*parent.children, self)
                self.evaporating = parent.evaporating and parent._flow is not here()
                self.reason = parent.reason if self.evaporating else ""
        self.tree.changed(self)

    # --- what it is ---------------------------------------------------------------------------------------------------

    @property
    def state(self) -> TaskState:
        return self.status.value

    @property
    def path(self) -> str:
        """Names from the root to here, with slashes."""
        above = f"{self.parent.path}/" if self.parent is not None else ""
        return above + self.name

    def __iter__(self) -> Iterator[Task]:
        """This task and all below, parents first."""
        yield self
        for child in self.children:
            yield from child

    def find(self, name: str) -> Task:
        """The task of that name, here or below; the newest of several."""
        found = [task for task in self if task.name == name]
        if not found:
            names = dict.fromkeys(task.name for task in self)
            raise PlanError(f"no task {name!r} in {self.path}{of_those(name, names)}")
        return found[-1]

    def __repr__(self) -> str:
        return f"<Task {self.path}: {self.state.value}>"

    # --- running ------------------------------------------------------------------------------------------------------

    def run(self) -> Any:
        """Run it in this thread; its answer. Raises PlanFailure if it failed, or was evaporated alone."""
        flow = here()
        if flow is None:
            raise PlanError(f"the task {self.name} is outside of a plan: use top_level, or run_and_tell")
        self._begin(flow)
        flow.tasks.append(self)
        try:
            flow.check()
            result = self._body()
            flow.check()
        except Evaporated as signal:
            self._end(TaskState.EVAPORATED, reason=signal.task.reason)
            # Looked at now, not when the signal came: a task above may have been evaporated meanwhile.
            above = flow.tasks[:-1] if self.parent is None else [*flow.tasks[:-1], self.parent]
            if any(task.evaporating for task in above):
                raise
            raise TaskEvaporatedFailure(self.path, self.reason) from None
        except BaseException as error:
            self._end(TaskState.FAILED, failure=error)
            raise
        else:
            self._end(TaskState.SUCCEEDED, result=result)
            return result
        finally:
            flow.tasks.pop()

    def start(self) -> Task:
        """Run it in a thread of its own; see `join`."""
        flow = Flow(self.tree.clock)
        with self.tree.lock:
            if self._thread is not None or self._flow is not None:
                raise PlanError(f"the task {self.path} was started before")
            self._thread = threading.Thread(target=self._run_alone, args=(flow,), name=self.path, daemon=True)
        self._thread.start()
        return self

    def join(self, timeout: float | None = None) -> bool:
        """Wait until it is over and its thread has ended, at most so many s of the tree's clock; whether it is over."""
        flow = here() or Flow(self.tree.clock)
        if not flow.wait(lambda: self.state.over, [self.status], timeout):
            return False
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()
        return True

    def value(self) -> Any:
        """Its answer.

        Raises:
            PlanFailure: Its failure; a TaskEvaporatedFailure if it was evaporated.
            PlanError: It is not over.
        """
        state = self.state
        if state is TaskState.SUCCEEDED:
            return self.result
        if state is TaskState.FAILED:
            assert self.failure is not None
            raise self.failure
        if state is TaskState.EVAPORATED:
            raise TaskEvaporatedFailure(self.path, self.reason)
        raise PlanError(f"the task {self.path} is {state.value}: it has no result yet")

    # --- from outside -------------------------------------------------------------------------------------------------

    def evaporate(self, reason: str = "evaporated") -> None:
        """End it and all below; returns at once, `join` waits. Finished tasks stay as they are."""
        with self.tree.lock:
            tasks = [task for task in self if not task.state.over and not task.evaporating]
            for task in tasks:
                task.evaporating = True
                task.reason = reason
            flows = {task._flow for task in tasks if task._flow is not None}
        for task in tasks:
            if task._flow is None and task._thread is None:
                task._end(TaskState.EVAPORATED)
        for flow in flows:
            flow.wake()

    def suspend(self, reason: str = "suspended") -> None:
        """Pause it and all below at the next point where they wait; each suspension needs a `wake_up`."""
        self._change_suspensions(1, reason)

    def wake_up(self, reason: str = "woken") -> None:
        """Take one suspension back; it goes on when none is left, here and above."""
        self._change_suspensions(-1, reason)

    @property
    def suspended(self) -> bool:
        """Whether it, or a task above, is to pause."""
        return self._suspensions > 0 or (self.parent is not None and self.parent.suspended)

    # --- inside -------------------------------------------------------------------------------------------------------

    def _run_alone(self, flow: Flow) -> None:
        """The thread of a task: errors are kept for `value`."""
        set_here(flow)
        try:
            self.run()
        except Evaporated:
            pass
        except BaseException as error:
            if self.state is not TaskState.FAILED and not isinstance(error, TaskEvaporatedFailure):
                raise
        finally:
            set_here(None)

    def _begin(self, flow: Flow) -> None:
        with self.tree.lock:
            if self._flow is not None:
                raise PlanError(f"the task {self.path} was run before")
            self._flow = flow
            self.began = self.tree.clock.now()
            if not self.state.over:
                self.status.value = TaskState.SUSPENDED if self.suspended else TaskState.RUNNING
        self.tree.changed(self)

    def _end(
        self, state: TaskState, result: Any = None, failure: BaseException | None = None, reason: str | None = None
    ) -> None:
        with self.tree.lock:
            if self.state.over:
                return
            self.result, self.failure = result, failure
            self.ended, self.ending = self.tree.clock.now(), next(self.tree.endings)
            if reason is not None and not self.reason:
                self.reason = reason
            self.status.value = state
        self.tree.changed(self)

    def _change_suspensions(self, by: int, reason: str) -> None:
        with self.tree.lock:
            if self._suspensions + by < 0:
                raise PlanError(f"the task {self.path} is not suspended")
            self._suspensions += by
            if not self.evaporating:  # why it ends says more
                self.reason = reason
            changed = [task for task in self if task._flow is not None and not task.state.over]
            for task in changed:
                task.status.value = TaskState.SUSPENDED if task.suspended else TaskState.RUNNING
            flows = {task._flow for task in changed}
        for task in changed:
            self.tree.changed(task)
        for flow in flows:
            flow.wake()


class TaskTree:
    """All tasks of one run of a plan.

    `lock`: held for bookkeeping only. `observers`: called with a task at every change, in the thread of the change.
    """

    def __init__(self, name: str, body: Callable[[], Any], clock: Any) -> None:
        self.clock = clock
        self.lock = threading.RLock()
        self.numbers = itertools.count()
        self.endings = itertools.count()
        self.observers: list[Callable[[Task], None]] = []
        self.root = Task(name, body, None, self)

    def changed(self, task: Task) -> None:
        for observe in tuple(self.observers):
            observe(task)


def current_task() -> Task:
    """The innermost task of this thread; PlanError outside of plans."""
    flow = here()
    if flow is None or not flow.tasks:
        raise PlanError("this is outside of a plan: begin it with top_level, or run_and_tell")
    return flow.tasks[-1]


def failed(task: Task) -> bool:
    """Whether a task ended without success."""
    return task.state in (TaskState.FAILED, TaskState.EVAPORATED)


def failure_of(task: Task) -> PlanFailure | BaseException:
    """The failure of a task that ended without success."""
    return task.failure if task.failure is not None else TaskEvaporatedFailure(task.path, task.reason)
