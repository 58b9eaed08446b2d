"""Calls of one of the robot's modules to another one, as a client makes them, in a thread of their own."""

from __future__ import annotations

import logging
import threading
from typing import Any, Callable

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.background import Background

log = logging.getLogger("nao_sim.services")


class ModuleCalls:
    """Calls modules one after the other; time that runs faster than the wall clock waits for them. Any thread.

    Attributes:
        holds: Whether time should wait.

    Args:
        broker: Finds modules: `service(name)`.
        released: Called when time need not wait any more.
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
