"""A goal of a server as pages show it: what it is, how far it is, and a way to cancel it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class GoalEnd:
    """A way in which a goal ends.

    Attributes:
        state: Its name in logs.
        status: Of actionlib_msgs/GoalStatus; None: the goal was never sent.
        word: What a button and a line say of it; empty: nothing.
    """

    state: str
    status: int | None
    word: str = ""

    @property
    def failed(self) -> bool:
        """Whether it is told until somebody has looked."""
        return bool(self.word)


SUCCEEDED = GoalEnd("succeeded", 3)
PREEMPTED = GoalEnd("preempted", 2, "stopped")
ABORTED = GoalEnd("aborted", 4, "failed")
REJECTED = GoalEnd("rejected", 5, "refused")
RECALLED = GoalEnd("recalled", 8, "stopped before it began")
LOST = GoalEnd("lost", 9, "lost")
NOT_SENT = GoalEnd("not sent", None, "not sent")
GOAL_ENDS = (SUCCEEDED, PREEMPTED, ABORTED, REJECTED, RECALLED, LOST, NOT_SENT)
"""All ways in which a goal ends, for logs and pages alike."""
ENDS = {end.status: end for end in GOAL_ENDS if end.status is not None}
STATES = {0: "pending", 1: "active", 6: "active", 7: "pending", **{status: end.state for status, end in ENDS.items()}}
"""States of actionlib_msgs/GoalStatus by their names in logs."""


def end_of(state: str) -> GoalEnd:
    """The end of a name. Raises KeyError where it is none."""
    return {end.state: end for end in GOAL_ENDS}[state]


@dataclass(eq=False)
class Run:
    """One goal, of this console or of another program. Any thread.

    Attributes:
        progress: The newest feedback, for people.
        result: Its fields as plain values; empty before the end, and for goals of others.
        sent: s of ROS time.
        state: pending, active, or the state of one of GOAL_ENDS.
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

    @property
    def succeeded(self) -> bool:
        return self.state == SUCCEEDED.state

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

    def end(self, end: GoalEnd, text: str = "", result: Mapping[str, Any] | None = None) -> None:
        """It is over; the first end counts."""
        with self._lock:
            if self.done:
                return
            self.state, self.text, self.result = end.state, text, result or {}
            self._over.set()
            listeners, self._listeners = self._listeners, []
        for listener in listeners:
            listener(self)
