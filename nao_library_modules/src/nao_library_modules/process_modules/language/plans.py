"""Plans as functions: every call of a function decorated with `def_plan` is a task."""

from __future__ import annotations

import functools
import logging
import threading
from collections.abc import Callable
from concurrent import futures
from concurrent.futures import Future
from typing import Any

from naoqi.errors import NaoError

from .control import do, name_of, subtask, top_level
from .failures import PlanFailure
from .flow import here
from .tasks import Task

log = logging.getLogger(__name__)


def def_plan(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function whose calls are tasks in the tree, with their arguments. Callable in plans only."""

    @functools.wraps(function)
    def plan(*arguments: Any, **keywords: Any) -> Any:
        return subtask(do(plan, *arguments, **keywords))

    plan.plan_body = function  # type: ignore[attr-defined]
    return plan


class StartedPlan:
    """A plan in a thread of its own; `run` receives an observer of its tree."""

    def __init__(self, name: str, run: Callable[[Callable[[Task], None]], Any]) -> None:
        self.name = name
        self._answer: Future = Future()
        self._lock = threading.Lock()
        self._root: Task | None = None
        self._cancelled = False
        threading.Thread(target=self._run, args=(run,), name=f"plan {name}", daemon=True).start()

    def done(self) -> bool:
        return self._answer.done()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for its end, at most so many s of this computer; whether it has ended."""
        return bool(futures.wait([self._answer], timeout).done)

    def result(self, timeout: float | None = None) -> Any:
        """Wait for its end, at most so many s of this computer; its answer.

        Raises:
            PlanFailure: What it failed with.
            NaoError: It has not ended in time; it goes on.
        """
        if not self.wait(timeout):
            raise NaoError(f"the plan {self.name} is not over after {timeout:g} s; it goes on")
        return self._answer.result()

    def cancel(self) -> None:
        """End it; `wait` waits for that."""
        with self._lock:
            self._cancelled = True
            root = self._root
        if root is not None:
            root.evaporate("cancelled")

    def _see(self, task: Task) -> None:
        with self._lock:
            first, self._root = self._root is None, self._root or task
            cancelled = first and self._cancelled
        if cancelled:
            task.evaporate("cancelled")

    def _run(self, run: Callable[[Callable[[Task], None]], Any]) -> None:
        try:
            value = run(self._see)
        except BaseException as error:
            if not isinstance(error, PlanFailure):  # a mistake in the plan: nobody may ever ask for the result
                log.exception("the plan %s ended by an unexpected error", self.name)
            self._answer.set_exception(error)
        else:
            self._answer.set_result(value)


def def_top_level_plan(function: Callable[..., Any]) -> Callable[..., Any]:
    """A plan that may be called anywhere: outside of plans it begins a tree of its own.

    `plan.start(...)` does not wait for its end: it returns a `StartedPlan`.
    """
    plan = def_plan(function)

    @functools.wraps(function)
    def begun(*arguments: Any, **keywords: Any) -> Any:
        if here() is not None:
            return plan(*arguments, **keywords)
        return top_level(do(plan, *arguments, **keywords), name=name_of(function))

    def start(*arguments: Any, **keywords: Any) -> StartedPlan:
        name, body = name_of(function), do(plan, *arguments, **keywords)
        return StartedPlan(name, lambda see: top_level(body, name=name, observers=[see]))

    begun.plan_body = function  # type: ignore[attr-defined]
    begun.start = start  # type: ignore[attr-defined]
    return begun
