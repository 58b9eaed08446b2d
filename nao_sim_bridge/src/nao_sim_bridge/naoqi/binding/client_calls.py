"""What calls of modules of clients have in common: none waits for ever, what waits is bounded, failures are told."""

from __future__ import annotations

import threading
import time
from typing import Any, Callable

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task

GIVEN_UP = load_sizes().clients.call_s
"""A module that has not answered a call for this time, s of wall time, is called no more: its program has stopped."""
PERIOD = 1.0
"""Between two looks for clients, s of wall time."""


class NoAnswer(RuntimeError):
    """A client has not answered."""


def answer(future: Any, news: threading.Condition, wanted: Callable[[], bool], limit: float | None = None) -> Any:
    """The value of a libqi future, once it has one.

    Waits twice: a process that was itself stopped finds the limit over and the answer waiting, and needs only a moment
    to read it.

    Args:
        news: Notified when `wanted` may have changed.
        wanted: Whether anybody still waits; called with `news` held.
        limit: How long to wait, s of wall time; None for `GIVEN_UP`.

    Raises:
        NoAnswer: It has none within the limit, or nobody wants it any more.
        RuntimeError: What the call ended with.
    """
    limit = GIVEN_UP if limit is None else limit

    def tell(_: Any) -> None:
        with news:
            news.notify_all()

    future.addCallback(tell)
    with news:
        for part in (0.8, 0.2):
            news.wait_for(lambda: future.isFinished() or not wanted(), part * limit)
    if not future.isFinished():
        future.cancel()
        raise NoAnswer(f"no answer within {limit:g} s")
    return future.value()


def worth_telling(count: int) -> bool:
    """Whether to log something that happens again and again: the first, the second, the fourth time..."""
    return count & (count - 1) == 0


class ClientWatch:
    """Kills tasks when no client is connected any more, of which libqi tells a service nothing. Any thread."""

    def __init__(self, connected: Callable[[], bool]) -> None:
        self._connected = connected
        self._lock = threading.Lock()
        self._tasks: list[Task] = []
        self._runs = False

    def add(self, task: Task) -> Task:
        """Look after a task until it has ended; returns it."""
        with self._lock:
            self._tasks.append(task)
            if not self._runs:
                self._runs = True
                threading.Thread(target=self._run, name="watch of clients", daemon=True).start()
        return task

    def _run(self) -> None:
        while True:
            time.sleep(PERIOD)
            with self._lock:
                self._tasks = tasks = [task for task in self._tasks if not task.finished]
                self._runs = bool(tasks)
            if not tasks:
                return
            if not self._connected():
                for task in tasks:
                    task.request_kill()
