"""A thread of a plan: how it waits, and how it is ended and suspended meanwhile.

Everything in a plan that takes time goes through `wait_until`: a plan can be ended, suspended and woken only there, and
where tasks begin and end. Code that blocks by other means cannot be interrupted.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from ...base.cancellation import CancellationToken
from .failures import PlanError
from .fluents import AnyFluent

_local = threading.local()


class Evaporated(BaseException):  # a signal that ends tasks, not an error
    """Ends a task from inside; `task` is the outermost one of this thread that has to end.

    Plans do not catch it; their clean-up belongs into `finally`.
    """

    def __init__(self, task: Any) -> None:
        super().__init__(task.path)
        self.task = task


class Interrupted(BaseException):  # a signal, as above
    """A suspension reached `retry_after_suspension`: its body ends, and begins again when the task is woken."""


class Flow:
    """A thread of a plan.

    Attributes:
        tasks: The tasks that it runs, the outermost first.
        deaf: Depth of `uninterrupted` blocks.
        restarting: Depth of `retry_after_suspension` blocks.
    """

    def __init__(self, clock: Any) -> None:
        self.clock = clock
        self.tasks: list[Any] = []
        self.deaf = 0
        self.restarting = 0
        self._signal = CancellationToken()

    def wake(self) -> None:
        """Re-evaluate the condition it waits for; any thread may call this."""
        self._signal.trigger()

    def check(self) -> None:
        """End here if the task is to end; pause here while it is suspended.

        Raises Evaporated if a task of this thread is to end; Interrupted if it is suspended, and inside of
        `retry_after_suspension`.
        """
        self._wait(lambda: True, None, waits=False)

    def wait(self, condition: Callable[[], Any], fluents: Iterable[AnyFluent], timeout: float | None) -> bool:
        fluents = tuple(fluents)
        for fluent in fluents:
            fluent.listen(self.wake)
        try:
            return self._wait(condition, timeout)
        finally:
            for fluent in fluents:
                fluent.unlisten(self.wake)

    def _wait(self, condition: Callable[[], Any], timeout: float | None, waits: bool = True) -> bool:
        while True:
            # Cleared before the look: what changes after it is seen in the next round.
            self._signal.clear()
            try:
                paused = not self.deaf and self._pauses()
            except Interrupted:
                if waits and condition():
                    return True  # it is done: nothing to begin again, and the task pauses when it goes on
                raise
            if paused:
                self._signal.wait(None)  # type: ignore[arg-type]
                continue
            if condition():
                return True
            if timeout is None:
                self._signal.wait(None)  # type: ignore[arg-type]
                continue
            if timeout <= 0.0:
                return False
            began = self.clock.now()
            self.clock.wait(timeout, self._signal)
            timeout -= max(self.clock.now() - began, 0.0)

    def _pauses(self) -> bool:
        """Whether it has to pause; raises if it has to end."""
        for task in self.tasks:
            if task.evaporating:
                raise Evaporated(task)
        paused = bool(self.tasks) and self.tasks[-1].suspended
        if paused and self.restarting:
            raise Interrupted
        return paused


def here() -> Flow | None:
    """The flow of this thread; None outside of plans."""
    return getattr(_local, "flow", None)


def set_here(flow: Flow | None) -> None:
    _local.flow = flow


def wait_until(condition: Callable[[], Any], fluents: Iterable[AnyFluent] = (), timeout: float | None = None) -> bool:
    """Wait for a condition, in a plan; whether it came true.

    `condition`: evaluated now, and at every pulse of a fluent. `timeout`: s of the plan's clock, without suspensions;
    None for no limit.
    """
    return _flow().wait(condition, fluents, timeout)


def checkpoint() -> None:
    """Let a plan that computes for long be ended and suspended here."""
    _flow().check()


def sleep(duration: float) -> None:
    """Wait, s of the plan's clock."""
    _flow().wait(lambda: False, (), duration)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Neither end nor suspend the task in this block: for clean-up in `finally`. Limit its waits."""
    flow = _flow()
    flow.deaf += 1
    try:
        yield
    finally:
        flow.deaf -= 1


def retry_after_suspension(body: Callable[[], Any]) -> Any:
    """Run a body that cannot pause: a suspension ends it, and it begins again when the task is woken.

    Its `finally` blocks run in between: a goal on the robot is cancelled and sent again.
    """
    flow = _flow()
    while True:
        flow.restarting += 1
        try:
            return body()
        except Interrupted:
            if flow.restarting > 1:
                raise  # the outermost body is the one that begins again
        finally:
            flow.restarting -= 1
        flow.check()


def _flow() -> Flow:
    flow = here()
    if flow is None:
        raise PlanError("this waits outside of a plan: begin it with top_level, or run_and_tell")
    return flow
