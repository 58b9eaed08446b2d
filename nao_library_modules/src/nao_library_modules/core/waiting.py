"""Waits that can be interrupted, what is asked once a connection, and who listens. No polling, no ROS."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Callable, Generic, Tuple, TypeVar

from .errors import Preempted


class CancellationToken:
    """Tells whoever waits to stop waiting.

    Triggering wakes the wait of this object and calls the wakers, so that a thread may wait on something else
    (a call to the robot, simulated time) and still be interrupted. Any thread may trigger; the lock is held
    for bookkeeping only, never while a waker runs, so triggering under a foreign lock (actionlib's) is safe.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._event = threading.Event()
        self._wakers: list[Callable[[], None]] = []
        self._reason: Exception | None = None
        self._stopped = False

    def trigger(self, reason: Exception | None = None) -> None:
        """End the present wait and all later ones until `clear`.

        `reason`: what `check` raises; Preempted if none is given. The first reason counts.
        """
        with self._lock:
            if self._reason is None:
                self._reason = reason or Preempted()
            self._event.set()
            wakers = list(self._wakers)
        for wake in wakers:
            wake()

    def stop(self) -> None:
        """Trigger for good: the node ends, `clear` has no effect any more."""
        with self._lock:
            self._stopped = True
        self.trigger()

    def clear(self) -> None:
        """Forget the trigger, unless stopped."""
        with self._lock:
            if not self._stopped:
                self._reason = None
                self._event.clear()

    def is_set(self) -> bool:
        return self._event.is_set()

    def check(self) -> None:
        """Raise the reason if triggered. Raises Preempted, or another reason that was given to `trigger`."""
        if self._event.is_set():
            with self._lock:
                reason = self._reason
            if reason is not None:
                try:
                    raise reason
                finally:
                    del reason  # else this frame and the error keep each other, and the goal that is being run

    def wait(self, timeout: float) -> bool:
        """Wait for the trigger. `timeout`: s of wall-clock time. Returns whether it was triggered."""
        return self._event.wait(timeout)

    @contextmanager
    def waking(self, wake: Callable[[], None]) -> Iterator[None]:
        """Call `wake` on a trigger while the block runs; at once if it is triggered already."""
        with self._lock:
            self._wakers.append(wake)
            triggered = self._event.is_set()
        if triggered:
            wake()
        try:
            yield
        finally:
            with self._lock:
                self._wakers.remove(wake)


class Listeners:
    """Functions that are called when something happens: `for listener in listeners: listener()`. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._all: dict[object, Callable[..., Any]] = {}

    def add(self, listener: Callable[..., Any]) -> Callable[[], None]:
        """Have a function called from now on, also one that is already; what comes back ends that."""
        key = object()
        with self._lock:
            self._all[key] = listener

        def end() -> None:
            with self._lock:
                self._all.pop(key, None)

        return end

    def __iter__(self) -> Iterator[Callable[..., Any]]:
        """Those of this moment; the lock is not held meanwhile."""
        with self._lock:
            return iter(list(self._all.values()))


class WallClock:
    """Time of the computer. `simulated`: whether it is the time of a simulation."""

    simulated = False

    def now(self) -> float:
        """Seconds since some fixed moment; never goes backwards."""
        return time.monotonic()

    def wait(self, duration: float, interrupt: CancellationToken) -> bool:
        """Wait, unless interrupted.

        `duration`: s, >= 0. `interrupt`: ends the wait. Returns whether the whole duration passed.
        """
        return not interrupt.wait(duration)


Answer = TypeVar("Answer")


class OncePerConnection(Generic[Answer]):
    """An answer of the robot, asked for when it is first needed and again after each reconnection.

    Any thread may ask; at worst two ask the robot at the same time.
    """

    def __init__(self, robot: Any, read: Callable[[], Answer]) -> None:
        self._connection = robot.connection
        self._read = read
        self._known: Tuple[int, Answer] | None = None

    def __call__(self) -> Answer:
        generation = self._connection.generation
        known = self._known
        if known is None or known[0] != generation:
            known = self._known = (generation, self._read())
        return known[1]
