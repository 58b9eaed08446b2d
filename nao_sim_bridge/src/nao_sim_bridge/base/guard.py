"""One guard for everything that is called in a tick or at the end of a task: what raises fails alone, and is named."""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass
from functools import partial
from typing import Any, Callable

log = logging.getLogger("nao_sim.guard")


@dataclass(frozen=True)
class Failure:
    """What has raised, as "module.function" of the package, its last error as a text, and how often it has raised."""

    culprit: str
    error: str
    count: int


class Guard:
    """Catches errors of what it calls, and remembers who raised them.

    The log has the first error of each culprit with its traceback and, as it goes on, each time that it is ten times as
    many: some raise at every tick. Any thread.
    """

    def __init__(self) -> None:
        self._failures: dict[tuple[str, type], Failure] = {}
        self._lock = threading.Lock()

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """What `function(*arguments)` returns; None when it raises."""
        try:
            return function(*arguments)
        except Exception as error:
            self.caught(function, error)
            return None

    def caught(self, culprit: Any, error: Exception) -> None:
        """Remember an error of a culprit (a function, or a text that names it), and tell it to the log."""
        name = culprit if isinstance(culprit, str) else name_of(culprit)
        with self._lock:
            before = self._failures.get((name, type(error)))
            count = 1 if before is None else before.count + 1
            failure = Failure(name, f"{type(error).__name__}: {error}", count)
            self._failures[(name, type(error))] = failure
        if count == 1:
            log.error("%s failed, everything else goes on", name, exc_info=error)
        elif set(str(count)[1:]) == {"0"} and str(count)[0] == "1":
            log.error("%s failed %d times: %s", name, count, failure.error)

    def failures(self) -> list[Failure]:
        """What has failed, in the order of the first times."""
        with self._lock:
            return list(self._failures.values())


def name_of(function: Any) -> str:
    """What a function, a method, a partial of one, or an object that can be called is called."""
    while isinstance(function, partial):
        function = function.func
    named = function if hasattr(function, "__qualname__") else type(function)
    return f"{named.__module__.partition('.')[2] or named.__module__}.{named.__qualname__}"
