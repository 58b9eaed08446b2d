"""A goal of a server as pages show it: what it is, how far it is, and a way to cancel it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

ENDS = {2: "preempted", 3: "succeeded", 4: "aborted", 5: "rejected", 8: "recalled", 9: "lost"}
"""States of actionlib_msgs/GoalStatus in which a goal is over."""
STATES = {0: "pending", 1: "active", 6: "active", 7: "pending", **ENDS}


@dataclass(eq=False)
class Run:
    """One goal, of this console or of another program. Any thread.

    Attributes:
        progress: The newest feedback, for people.
        result: Its fields as plain values; empty before the end, and for goals of others.
        sent: s of ROS time.
        state: pending, active, succeeded, aborted, preempted, rejected, recalled, lost.
    """

    id: str
    robot: str  # namespace
    server: str  # relative name of the action
    functions: Sequence[str]  # of its chain
    label: str
    by: str  # who sent it at this console; empty: another program
    sent: float
    cancel_goal: Callable[[], None] = field(repr=False, default=lambda: None)
    state: str = "pending"
    text: str = ""
    progress: str = ""
    result: Mapping[str, Any] = field(default_factory=dict)
    feedback: Mapping[str, Any] = field(default_factory=dict)
    _over: threading.Event = field(default_factory=threading.Event, repr=False)
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)
    _listeners: list[Callable[[Run], None]] = field(default_factory=list, repr=False)

    @property
    def done(self) -> bool:
        return self._over.is_set()

    def cancel(self) -> None:
        """Have it ended, unless it is over."""
        if not self.done:
            self.cancel_goal()

    def on_end(self, listener: Callable[[Run], None]) -> None:
        """Have its end told, in the thread that learns of it; at once if it is over."""
        with self._lock:
            if not self.done:
                self._listeners.append(listener)
                return
        listener(self)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for its end, s of this computer; whether it is over. Not for the event loop of pages."""
        return self._over.wait(timeout)

    def end(self, state: str, text: str = "", result: Mapping[str, Any] | None = None) -> None:
        """It is over; the first end counts."""
        with self._lock:
            if self.done:
                return
            self.state, self.text, self.result = state, text, result or {}
            self._over.set()
            listeners, self._listeners = self._listeners, []
        for listener in listeners:
            listener(self)
