"""A robot that has never been reached yet: what is asked of it right after the start waits until it is there."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import Any

from ..base.cancellation import CancellationToken
from ..base.field_checks import number_parameter
from ..base.limits import limit

log = logging.getLogger(__name__)


def require_start_patience(value: Any) -> float:
    return number_parameter("~start_patience", value, limit("wait"))


class StartupGrace:
    """Waits for a robot that has never been reached; for one that went away nobody waits.

    Any thread may wait. Time is that of the computer, for simulated time may not have begun. `patience`: s from now on
    for which goals wait.
    """

    def __init__(self, robot: Any, patience: float) -> None:
        self._robot = robot
        self._deadline = time.monotonic() + patience

    @property
    def expected(self) -> bool:
        """Whether the robot may still come for the first time."""
        connection = self._robot.connection
        never = connection.generation == 0 and connection.state == "connecting"
        return never and time.monotonic() < self._deadline

    def wait(self, interrupt: CancellationToken, tell: Callable[[str], None]) -> None:
        """Wait until the robot is there, the time is over, or something interrupts.

        `interrupt`: ends the wait. `tell`: gets what is waited for, "the robot at ...", if that takes any time.
        """
        if not self.expected or interrupt.is_set():
            return
        awaited = f"the robot at {self._robot.address}"
        limit = self._deadline - time.monotonic()
        log.info("a goal waits for %s, which was not reached yet: up to %.0f s more", awaited, limit)
        tell(awaited)
        changed = threading.Event()
        listener = lambda *_: changed.set()  # noqa: E731
        self._robot.connection.add_listener(listener)
        try:
            if self.expected:  # it may have come before the listener
                with interrupt.waking(changed.set):
                    changed.wait(limit)
        finally:
            self._robot.connection.remove_listener(listener)
