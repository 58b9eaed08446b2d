"""The log and the line of diagnostics of nao_walker: commands and failures."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Sequence

from ...ros.health import Level, Report

log = logging.getLogger(__name__)

IS_ACTIVE = "moveIsActive"
"""The method that the report asks: its answer says nothing about commands."""
COMPLAINT_PERIOD = 5.0
"""s of real time from one complaint to the next about the same thing."""


class WalkJournal:
    """Remembers commands and failures. Every method may be called from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._complained: dict[str, float] = {}
        self._command = ""
        self._commanded_at = 0.0
        self._failures = 0
        self._last_failure = ""
        self._failing = ""  # what failed last, and has not succeeded since

    def commanded(self, source: str, now: float) -> None:
        with self._lock:
            self._command, self._commanded_at = source, now

    def succeeded(self, name: str) -> None:
        """The robot carried a command out, or answered: a command clears any failure, IS_ACTIVE its own."""
        with self._lock:
            if name != IS_ACTIVE or self._failing == name:
                self._failing = ""

    def failed(self, name: str, error: BaseException) -> None:
        with self._lock:
            self._failures += 1
            self._failing = name
            self._last_failure = f"{name}: {error}"
        if self._is_due(f"{name} failed"):
            log.error("%s: %s", name, error)

    def warn(self, key: str, text: str) -> None:
        """Log a warning, but not all the time about the same `key`."""
        if self._is_due(key):
            log.warning("%s", text)

    def report(self, now: float, doing: str, active: bool | None, owners: Sequence[str], watchdog_stops: int) -> Report:
        """The line of diagnostics at `now` s of ROS time.

        `doing` is what the node has the robot do, `active` whether the robot answers that it walks (None: not asked).
        """
        with self._lock:
            age = f"{now - self._commanded_at:.1f}" if self._command else ""
            values = {
                "commanded": doing,
                "robot": {None: "unknown", True: "walks", False: "stands"}[active],
                "inhibited by": ", ".join(owners),
                "last command": self._command,
                "last command (s ago)": age,
                "stopped because commands ceased": str(watchdog_stops),
                "commands that failed": str(self._failures),
                "last failure": self._last_failure,
            }
            failing = self._failing
        message = values["robot"] + (f", inhibited by {values['inhibited by']}" if owners else "")
        if failing:
            return Report(Level.WARN, f"{message}; {values['last failure']}", values)
        return Report(Level.OK, message, values)

    def _is_due(self, key: str) -> bool:
        now = time.monotonic()
        with self._lock:
            due = now - self._complained.get(key, now - 2 * COMPLAINT_PERIOD) >= COMPLAINT_PERIOD
            if due:
                self._complained[key] = now
            return due
