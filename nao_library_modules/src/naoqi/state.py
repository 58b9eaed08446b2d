"""Where a connection stands, who wants to hear of it, and how patient it is."""

from __future__ import annotations

import enum
import logging
import threading
from dataclasses import dataclass
from typing import Callable, List, Sequence

from .worker import Worker

logger = logging.getLogger("naoqi")


class State(str, enum.Enum):
    """Where a connection stands; equal to its text, so `connection.state == "connected"` works."""

    CONNECTING = "connecting"
    CONNECTED = "connected"
    LOST = "lost"
    CLOSED = "closed"

    def __str__(self) -> str:
        return self.value


@dataclass(frozen=True)
class Timing:
    """How patient a connection is, all in s.

    A silent robot is given up `heartbeat_period + heartbeat_limit` after its last sign of life at the latest,
    so the defaults make calls under way fail within 2 s. Raise the limit where a slow network carries large
    images: the answer to a heartbeat has to wait behind them.
    """

    heartbeat_period: float = 0.3  # pause between two heartbeats
    heartbeat_limit: float = 1.3  # a heartbeat must be answered within this time
    connect_limit: float = 5.0  # an attempt to connect is given up after this time
    first_delay: float = 0.2  # pause after the first failed attempt; it doubles with each further one
    longest_delay: float = 2.0  # longest pause between two attempts
    patience: float = 10.0  # a robot that has not been reached for so long is complained about in the log


Listener = Callable[[State], None]


class Listeners:
    """Functions that are called with each new state, one after the other, in one thread."""

    def __init__(self, name: str) -> None:
        """Make an empty list. `name`: of the thread."""
        self._lock = threading.Lock()  # guards the list; not held during calls
        self._listeners: List[Listener] = []
        self._worker = Worker(name)

    def add(self, listener: Listener) -> None:
        """Call this function after those that are here already."""
        with self._lock:
            self._listeners.append(listener)

    def remove(self, listener: Listener) -> None:
        """Call this function no more; one that was never added is no error."""
        with self._lock:
            if listener in self._listeners:
                self._listeners.remove(listener)

    def tell(self, state: State) -> None:
        """Have everybody who is here now called with this state; does not wait for it."""
        with self._lock:
            listeners = tuple(self._listeners)
        self._worker.submit(lambda: self._call(listeners, state))

    def in_background(self, job: Callable[[], None]) -> None:
        """Have a job done in the same thread, after what has been told already."""
        self._worker.submit(job)

    def close(self) -> None:
        """Tell nothing more; wait a moment for what has been told already."""
        self._worker.close(timeout=1.0)

    def _call(self, listeners: Sequence[Listener], state: State) -> None:
        for listener in listeners:
            with self._lock:
                removed = listener not in self._listeners
            try:
                if not removed:
                    listener(state)
            except Exception:
                logger.exception("listener %r of a connection failed at state %s", listener, state)
