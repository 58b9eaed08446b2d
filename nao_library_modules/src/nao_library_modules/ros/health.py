"""What a module has to say about itself: connection, goals, launch file. Plain facts; no ROS."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from ..processes.supervisor import Supervisor, SupervisorState

SLOW_ANSWER = 0.5
"""A robot that takes longer than this (s) to answer is reported as slow."""

SILENT = "silent"
"""State, among those of the connection, of a robot that does not answer but is not lost yet."""


SILENT_FOR = "silent for (s)"
"""Value of a report about the connection: how long the robot has not answered, 0 while it does."""
RECORDINGS, STARTED = "recordings", "started"
"""Values of a report about recordings: their names, a list as JSON; when the process was started, s since 1970."""
_STARTED = f"{time.time():.3f}"


class Level(IntEnum):
    """Severity, with the numbers of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(frozen=True)
class Report:
    """One line of diagnostics."""

    level: Level  # severity
    message: str  # what is the matter, in words
    values: dict[str, str] = field(default_factory=dict)  # facts by name
    state: str = ""  # the message in a word or two, without numbers, for a summary of several reports


class GoalCounter:
    """Counts goals by how they ended. Written by the thread that executes goals, read by the diagnostics."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._counts = {"succeeded": 0, "preempted": 0, "aborted": 0}
        self._last_error = ""

    def ended(self, end: str, text: str) -> None:
        """Count a goal. `end`: succeeded, preempted or aborted. `text`: why, for an aborted one."""
        with self._lock:
            self._counts[end] += 1
            if end == "aborted":
                self._last_error = text

    def report(self) -> Report:
        """Counts, and why the last goal was aborted; always OK, for a bad goal is its sender's matter."""
        with self._lock:
            values = {name: str(count) for name, count in self._counts.items()}
            values["last error"] = self._last_error
        return Report(Level.OK, "ready for goals", values)


def connection_report(address: str, connection: Any) -> Report:
    """State of the connection to the robot. `address`: `ip:port`. `connection`: connection of the proxy layer."""
    latency, silent = connection.latency, connection.silent
    values = {
        "address": address,
        "state": SILENT if silent else str(connection.state),
        SILENT_FOR: f"{silent:.1f}",
        "latency (ms)": "" if latency is None else f"{1000.0 * latency:.1f}",
        "connections made": str(connection.generation),
        "last error": connection.last_error or "",
    }
    if silent:
        # Without how long it is: what all nodes report alike is told once.
        patience = connection.timing.patience
        message = f"silent: goals and calls wait, until the robot is lost after {patience:g} s without an answer"
        return Report(Level.WARN, message, values)
    if values["state"] != "connected":
        return Report(Level.ERROR, f"{values['state']}: {values['last error'] or 'no answer yet'}", values)
    if latency is not None and latency > SLOW_ANSWER:
        return Report(Level.WARN, f"connected, but answers take {latency:.1f} s", values)
    return Report(Level.OK, "connected", values)


def recordings_report(names: Iterable[str]) -> Report:
    """What a server records at this moment. `names`: of the recordings that get something to record."""
    running = sorted(names)
    values = {RECORDINGS: json.dumps(running), STARTED: _STARTED}
    return Report(Level.OK, f"records {', '.join(running) or 'nothing'}", values)


def launch_report(supervisor: Supervisor | None) -> Report:
    """State of the launch file that belongs to a module; None when the module has not started it."""
    if supervisor is None:
        return Report(Level.OK, "left to others")
    status = supervisor.status
    values = {
        "state": status.state.value,
        "process": "" if status.pid is None else str(status.pid),
        "restarts": str(status.restarts),
        "last end": status.last_end,
    }
    if status.state is SupervisorState.RUNNING:
        return Report(Level.WARN if status.restarts else Level.OK, "running", values)
    if status.state is SupervisorState.WAITING:
        return Report(Level.ERROR, f"{status.last_end}; it is started again", values)
    return Report(Level.WARN, status.last_end or "not started", values)
