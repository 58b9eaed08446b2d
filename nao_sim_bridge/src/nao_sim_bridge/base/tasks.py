"""Tasks: work that takes simulated time and that somebody may wait for, cancel or kill.

A task is finished by the simulation thread. Everything else (a libqi service, a test) only looks at it, adds a
callback, or asks for its end; the callback runs in the thread that finishes the task and must not block.
"""

from __future__ import annotations

import itertools
import threading
from collections import deque
from typing import Any, Callable

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.base.guard import Guard


class Task:
    """One piece of work in simulated time.

    Attributes:
        name: NAOqi name of the call that made it, for example "angleInterpolation".
        task_id: Positive number, unique within its `TaskIds`.
        killed: True when it ended by `kill` and not by itself.
        value: The result of a finished task; None before, and after an error.
        error: The error that ended the task, None when there was none.

    Args:
        on_kill: Called in the simulation thread when the task is killed, to drop the work.
        ask: Called with the task when another thread requests its end.
        guard: Calls what is called at its end; None for one of its own.
    """

    def __init__(
        self,
        name: str,
        task_id: int,
        on_kill: Callable[[Task], None] | None = None,
        ask: Callable[[Task], None] | None = None,
        guard: Guard | None = None,
    ) -> None:
        self.name = name
        self.task_id = task_id
        self.killed = False
        self._on_kill = on_kill
        self._ask = ask
        self._guard = guard or Guard()
        self._lock = threading.Lock()
        self._finished = threading.Event()
        self._callbacks: list[Callable[[Task], None]] = []
        self.value: Any = None
        self.error: Exception | None = None

    @property
    def finished(self) -> bool:
        """True once the task has ended, in whatever way."""
        return self._finished.is_set()

    def finish(self, result: Any = None, error: Exception | None = None) -> bool:
        """End the task. Returns False when it had ended before."""
        with self._lock:
            if self._finished.is_set():
                return False
            self.value, self.error = result, error
            self._finished.set()
            callbacks, self._callbacks = self._callbacks, []
            # Its owner mostly keeps the task, too: such a cycle would keep long sounds in memory for a while.
            self._on_kill = None
        for callback in callbacks:
            self._guard.call(callback, self)
        return True

    def finish_with(self, command: Callable[[], Any]) -> None:
        """End the task with what `command()` returns or raises."""
        try:
            result = command()
        except Exception as error:
            self.finish(error=error)
        else:
            self.finish(result)

    def request_kill(self) -> None:
        """Ask for the end of the task, and of the one it leads to, from any thread; `TaskIds.ask` hears it."""
        if self._ask is not None:
            self._ask(self)
        # A command that has not run yet cannot be stopped, but what it is about to start can.
        self.add_done_callback(lambda done: done.value.request_kill() if isinstance(done.value, Task) else None)

    def kill(self) -> bool:
        """End the task before its time; whoever owns the work drops it. Simulation thread only."""
        with self._lock:
            if self._finished.is_set():
                return False
            self.killed = True
            on_kill = self._on_kill
        if on_kill is not None:
            self._guard.call(on_kill, self)
        self.finish()
        return True

    def add_done_callback(self, callback: Callable[[Task], None]) -> None:
        """Call `callback(task)` at the end of the task, at once when it has ended already."""
        with self._lock:
            if not self._finished.is_set():
                self._callbacks.append(callback)
                return
        self._guard.call(callback, self)

    def remove_done_callback(self, callback: Callable[[Task], None]) -> None:
        """Do not call a callback that was added and has not been called yet."""
        with self._lock:
            if callback in self._callbacks:
                self._callbacks.remove(callback)

    def then(self, change: Callable[[Any], Any]) -> Task:
        """A task that ends with this one, its result passed through `change`; it fails where that raises."""
        after = Task(self.name, self.task_id, ask=lambda _: self.request_kill(), guard=self._guard)

        def settle(done: Task) -> None:
            after.killed = done.killed
            if done.error is not None:
                after.finish(error=done.error)
            else:
                after.finish_with(lambda: change(done.value))

        self.add_done_callback(settle)
        return after

    def result(self, timeout: float | None = None) -> Any:
        """Wait for the end (wall time, s) and return the result.

        Raises:
            TimeoutError: The task has not ended within `timeout`.
            Exception: Whatever error ended the task.
        """
        if not self._finished.wait(timeout):
            raise TimeoutError(f"task {self.name} ({self.task_id}) has not ended within {timeout} s")
        if self.error is not None:
            raise self.error
        return self.value


class TaskIds:
    """Source of task numbers; a fresh simulation starts at 1, so that equal runs number equally.

    Attributes:
        ask: Called with a task whose end another thread requests; who runs the simulation in a thread sets it to
            something that kills the task there.
        guard: Calls what is called at the end of each task.
    """

    def __init__(self) -> None:
        self._count = itertools.count(1)
        self.ask: Callable[[Task], None] | None = None
        self.guard = Guard()

    def make(self, name: str, on_kill: Callable[[Task], None] | None = None) -> Task:
        """A new task of the next number; `on_kill` drops its work, in the simulation thread, when it is killed."""
        return Task(name, next(self._count), on_kill, lambda task: self.ask(task) if self.ask else None, self.guard)


def stopped_error() -> SimulationStopped:
    """The error for everything that waits when the simulation ends."""
    return SimulationStopped("the simulation has stopped")


class WorkThreads:
    """Does jobs in up to `most` threads, which end when nothing is left to do; further jobs wait for their turn."""

    def __init__(self, name: str, most: int = 1) -> None:
        self._name = name
        self._most = most
        self._lock = threading.Lock()
        self._jobs: deque[Callable[[], Any]] = deque()
        self._threads = 0

    def do(self, job: Callable[[], Any]) -> None:
        """Do a job, which raises nothing; returns at once."""
        with self._lock:
            self._jobs.append(job)
            if self._threads >= self._most:
                return
            self._threads += 1
        threading.Thread(target=self._work, name=self._name, daemon=True).start()

    def work_out(self, name: str, work: Callable[[], Any]) -> Task:
        """A task that ends with what `work` returns or raises."""
        task = Task(name, 0)
        self.do(lambda: task.finish_with(work))
        return task

    def _work(self) -> None:
        while True:
            with self._lock:
                if not self._jobs:
                    self._threads -= 1
                    return
                job = self._jobs.popleft()
            job()
            del job  # what it leads to is not kept until the next one
