"""Waiting for fluents."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

from .control import Step, subtask
from .flow import checkpoint, wait_until
from .fluents import AnyFluent, Pulsed


def wait_for(fluent: AnyFluent, timeout: float | None = None) -> Any:
    """Wait until a fluent is true; its value, or False after the timeout.

    Args:
        timeout: s of the plan's clock; None for no limit.
    """
    seen: list[Any] = []

    def look() -> bool:
        if isinstance(fluent, Pulsed):
            value: Any = fluent.take()
        else:
            value = fluent.value
        seen[:] = [value]
        return bool(value)

    return seen[0] if wait_until(look, [fluent], timeout) else False


def whenever(fluent: AnyFluent, body: Callable[[], Any], missed: str = "once") -> NoReturn:
    """Run a body at every pulse at which a fluent is true, and now if it is; never ends by itself.

    Put it beside something else: `pursue(do(whenever, ...), plan)`. Of a `pulsed` fluent see `Pulsed` for `missed`: of
    the pulses that come while the body runs, "never" forgets all, "once" runs it once more, "always" once for each.
    """

    def watch() -> NoReturn:
        pulses = Pulsed(fluent, missed)
        if fluent.value:
            body()
            pulses.forget_missed()
        while True:
            wait_for(pulses)
            if fluent.value:
                body()
            pulses.forget_missed()
            checkpoint()

    return subtask(Step(f"whenever {fluent.name}", watch))
