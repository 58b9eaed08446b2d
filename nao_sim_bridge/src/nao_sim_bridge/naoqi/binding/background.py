"""Work in threads of its own, so that calls behind it get through: reading a long file, calling another module."""

from __future__ import annotations

import logging
import math
import threading
from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task, WorkThreads

Wanted = Callable[[], bool]
Work = Callable[[Wanted], Any]


class Background:
    """Jobs in threads of their own; `released` is called when `holds` has become False.

    `most`: how many may be asked for that have not ended; `threads`: how many of them are done at the same time.
    """

    def __init__(self, released: Callable[[], None] = lambda: None, most: float = math.inf, threads: int = 1) -> None:
        self._released = released
        self._most = most
        self._lock = threading.Lock()
        self._threads = WorkThreads("background", threads)
        self.unfinished = 0  # jobs in turn that have not ended
        self._stops = 0
        self._closed = False

    def holds(self) -> bool:
        """Whether time that runs faster than the wall clock should wait, as for a robot the work takes next to none."""
        return self.unfinished > 0

    def stop(self) -> None:
        """Nobody wants what has been asked for up to now."""
        self._stops += 1

    def close(self) -> None:
        """Nobody wants anything any more, what is asked for later neither."""
        self._closed = True

    def in_turn(self, work: Work, name: str) -> Task:
        """Do something after what was asked for before, or beside it if there are `threads`; time that runs fast waits.

        `work` is called with a function that answers whether anybody still wants the result; when it returns a task,
        time waits for that as well. The task that this returns ends with what `work` returns or raises, or when nobody
        wants it any more. A BadValue when too many wait for their turn.
        """
        with self._lock:
            if self.unfinished >= self._most:
                raise BadValue(f"calls of {name} that have not ended", self.unfinished + 1, f"at most {self._most}")
            self.unfinished += 1
        task, job = self._job(work, name, self._finished)
        self._threads.do(job)
        return task

    def _job(self, work: Work, name: str, finished: Callable[[], None]) -> tuple[Task, Callable[[], None]]:
        stops, cancelled = self._stops, threading.Event()

        def cancel(asked: Task) -> None:
            cancelled.set()
            asked.killed = asked.killed or not asked.finished
            asked.finish()

        def wanted() -> bool:
            return not self._closed and self._stops == stops and not cancelled.is_set()

        task = Task(name, 0, ask=cancel)

        def job() -> None:
            try:
                result = work(wanted)
            except Exception as error:
                # What was stopped half way may well have failed; nobody wants to know.
                task.finish(error=error if wanted() else None)
                finished()
                return
            task.finish(result)
            if isinstance(result, Task):
                result.add_done_callback(lambda _: finished())
            else:
                finished()

        return task, job

    def _finished(self) -> None:
        with self._lock:
            self.unfinished -= 1
        self._released()


log = logging.getLogger("nao_sim.services")


class ModuleCalls:
    """Calls modules one after the other; time that runs faster than the wall clock waits for them. Any thread.

    The `broker` finds modules by `service(name)`; `holds` says whether time should wait, `released` is called when it
    need not any more.
    """

    def __init__(self, broker: Any, released: Callable[[], None]) -> None:
        self._broker = broker
        self._background = Background(released)
        self._calling = threading.Lock()
        self._closed = False
        self.holds = self._background.holds

    def call(self, module: str, method: str, *arguments: Any) -> Task:
        """Call a method that is answered at once; the task ends with what it answers, or with its error."""

        def call(_: Any) -> Any:
            with self._calling:
                return None if self._closed else self._broker.service(module).call(method, *arguments)

        return self._background.in_turn(call, f"{module}.{method}")

    def close(self) -> None:
        """Call nothing any more; waits for the call that is under way."""
        with self._calling:
            self._closed = True

    def tell(self, module: str, method: str, *arguments: Any) -> None:
        """As `call`, for who does not wait: a failure goes to the log."""

        def over(done: Task) -> None:
            if done.error is not None:
                log.warning("%s.%s: %s", module, method, done.error)

        self.call(module, method, *arguments).add_done_callback(over)
