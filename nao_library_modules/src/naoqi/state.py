"""Where a connection stands, and who wants to hear of it."""

from __future__ import annotations

import enum
import logging
import threading
from typing import Callable, Dict, Sequence

from .worker import Worker

logger = logging.getLogger("naoqi")


class State(str, enum.Enum):
    """Where a connection stands; equal to its text, so `connection.state == "connected"` works.

    A connected robot may be silent for a while: see `Connection.silent`.
    """

    CONNECTING = "connecting"
    CONNECTED = "connected"
    LOST = "lost"
    CLOSED = "closed"

    def __str__(self) -> str:
        return self.value


Listener = Callable[[State], None]


class Listeners:
    """Functions that are called with each new state, one after the other, in one thread."""

    def __init__(self, name: str) -> None:
        """Make an empty list. `name`: of the thread."""
        self._lock = threading.Lock()  # guards the list; not held during calls
        self._listeners: Dict[Listener, bool] = {}  # whether it hears of silence as well; in the order of their calls
        self._worker = Worker(name)

    def add(self, listener: Listener, silence: bool) -> None:
        """Call this function after those that are here already; at the begin and end of silence only with `silence`."""
        with self._lock:
            self._listeners[listener] = silence

    def remove(self, listener: Listener) -> None:
        """Call this function no more; one that was never added is no error."""
        with self._lock:
            self._listeners.pop(listener, None)

    def tell(self, state: State, silence: bool = False) -> None:
        """Have those who are here now called with this state; does not wait for it. `silence`: it began or ended."""
        with self._lock:
            listeners = tuple(each for each, hears in self._listeners.items() if hears or not silence)
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
