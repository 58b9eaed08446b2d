"""Failure handling: what a plan does about a failure, and how often it tries again.

    def again(failure):
        go_elsewhere()
        do_retry("navigation")                     # returns after the third time
        fail(NavigationHighLevelFailure, str(failure))

    with with_retry_counters(navigation=3):
        with_failure_handling(do(walk_to, table), {NavigationLowLevelFailure: again})

A handler may try again (`retry`, `do_retry`), answer for the body (`give`), fail with something else, or return: then
the failure is passed up.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NoReturn, Tuple, Type, Union

from ...base.suggestion import of_those
from .control import Branch, Step, subtask
from .failures import PlanError, PlanFailure
from .tasks import Task, current_task

Kinds = Union[Type[PlanFailure], Tuple[Type[PlanFailure], ...]]
COUNTERS = "retry counters"
HANDLING = "handling"


class _Retry(BaseException):
    """A handler has the body run again."""


class _Give(BaseException):
    def __init__(self, value: Any) -> None:
        super().__init__()
        self.value = value


def with_failure_handling(body: Branch, handlers: Mapping[Kinds, Callable[[PlanFailure], Any]]) -> Any:
    """Run a body; on a failure, run the first handler that matches. The answer is the body's, or that of `give`.

    `handlers`: by class of failures, or by a tuple of classes. Raises PlanFailure if no handler matches or it passes
    the failure up, or it fails itself.
    """
    for kinds in handlers:
        for kind in kinds if isinstance(kinds, tuple) else (kinds,):
            if not (isinstance(kind, type) and issubclass(kind, PlanFailure)):
                raise PlanError(f"with_failure_handling: {kind!r} is no class of PlanFailure")

    def handled() -> Any:
        while True:
            try:
                return subtask(body)
            except PlanFailure as failure:
                handler = next((each for kinds, each in handlers.items() if isinstance(failure, kinds)), None)
                if handler is None:
                    raise
                current_task().scope[HANDLING] = True
                try:
                    handler(failure)
                except _Retry:
                    continue
                except _Give as given:
                    return given.value
                finally:
                    del current_task().scope[HANDLING]
                raise

    return subtask(Step("with_failure_handling", handled))


def retry() -> NoReturn:
    """In a handler: run the body again."""
    _check_handling("retry")
    raise _Retry


def give(value: Any = None) -> NoReturn:
    """In a handler: answer for the body."""
    _check_handling("give")
    raise _Give(value)


@contextmanager
def with_retry_counters(**counters: int) -> Iterator[None]:
    """Counters that `do_retry` counts down in this block, by name."""
    scope = current_task().scope
    kept = scope.get(COUNTERS, {})
    scope[COUNTERS] = {**kept, **{name: [left, left] for name, left in counters.items()}}
    try:
        yield
    finally:
        scope[COUNTERS] = kept


def do_retry(counter: str, before: Callable[[], Any] | None = None) -> None:
    """In a handler: run the body again, after `before`, if the counter allows it, and count it down; else return."""
    entry = _counter(counter)
    _check_handling("do_retry")
    with current_task().tree.lock:  # branches beside each other may share it
        if entry[0] <= 0:
            return
        entry[0] -= 1
    if before is not None:
        before()
    retry()


def get_counter(counter: str) -> int:
    """How many tries `do_retry` has left."""
    return _counter(counter)[0]


def reset_counter(counter: str) -> None:
    """Set a counter back to its start."""
    entry = _counter(counter)
    entry[0] = entry[1]


def _check_handling(what: str) -> None:
    """PlanError outside of a handler: the signal would leave the plan."""
    if not any(HANDLING in scope for scope in _scopes()):
        raise PlanError(f"{what} outside of a handler: see with_failure_handling")


def _counter(name: str) -> list[int]:
    counters = ChainMap(*(scope.get(COUNTERS, {}) for scope in _scopes()))
    if name not in counters:
        raise PlanError(f"no retry counter {name!r}{of_those(name, counters)}; see with_retry_counters")
    return counters[name]


def _scopes() -> Iterator[dict[str, Any]]:
    """Variables of this task and those above, the innermost first."""
    task: Task | None = current_task()
    while task is not None:
        yield task.scope
        task = task.parent
