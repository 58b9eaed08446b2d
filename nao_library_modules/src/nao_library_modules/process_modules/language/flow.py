"""One thread of a plan: how it waits, and how it is ended and suspended while it does.

Everything in a plan that takes time goes through `wait_until`: only there, and where tasks begin and end, a plan can be
ended, suspended and woken. Code that blocks by other means is deaf meanwhile.
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


class Evaporated(BaseException):  # noqa: N818  a signal that ends tasks, not an error
    """Ends a task from inside. Plans do not catch it; what they have to put right belongs into `finally`.

    Attributes:
        task: The outermost task of this thread that has to end.
    """

    def __init__(self, task: Any) -> None:
        super().__init__(task.path)
        self.task = task


class Interrupted(BaseException):  # noqa: N818  a signal, as above
    """A suspension reached a `retry_after_suspension`: its body ends, and begins again when the task is woken."""


class Flow:
    """A thread of a plan.

    Attributes:
        clock: Of the tree.
        tasks: That it runs, the outermost first.
        deaf: How many blocks of `uninterrupted` it is in.
        restarting: How many blocks of `retry_after_suspension` it is in.

    Args:
        clock: See above.
    """

    def __init__(self, clock: Any) -> None:
        self.clock = clock
        self.tasks: list[Any] = []
        self.deaf = 0
        self.restarting = 0
        self._signal = CancellationToken()

    def wake(self) -> None:
        """Have it look again at what it waits for; any thread may call this."""
        self._signal.trigger()

    def check(self) -> None:
        """End here if the task is to end; pause here while it is suspended.

        Raises:
            Evaporated: A task of this thread is to end.
            Interrupted: It is suspended, and inside of `retry_after_suspension`.
        """
        self._wait(lambda: True, None, waits=False)

    def wait(self, condition: Callable[[], Any], fluents: Iterable[AnyFluent], timeout: float | None) -> bool:
        """See `wait_until`."""
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
        """Whether it has to pause; raises where it has to end."""
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
    """Say which flow this thread is."""
    _local.flow = flow


def wait_until(condition: Callable[[], Any], fluents: Iterable[AnyFluent] = (), timeout: float | None = None) -> bool:
    """Wait for a condition, in a plan.

    Args:
        condition: Looked at now, and again whenever one of the fluents pulses.
        fluents: On which it depends.
        timeout: s of the plan's clock; a suspension does not count. None to wait for ever.

    Returns:
        Whether the condition came true.
    """
    return _flow().wait(condition, fluents, timeout)


def checkpoint() -> None:
    """A point where a plan that computes for long can be ended and suspended."""
    _flow().check()


def sleep(duration: float) -> None:
    """Let time of the plan's clock pass, s."""
    _flow().wait(lambda: False, (), duration)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """In this block nothing ends or suspends the task: for what has to be put right in `finally`. Bound its waits."""
    flow = _flow()
    flow.deaf += 1
    try:
        yield
    finally:
        flow.deaf -= 1


def retry_after_suspension(body: Callable[[], Any]) -> Any:
    """Run a body that cannot pause: a suspension ends it, and it begins again when the task is woken.

    Its `finally` blocks run in between, so that a goal on the robot is cancelled and sent again.
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
