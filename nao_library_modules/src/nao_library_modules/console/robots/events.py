"""What happens to a robot, as a stream that pages and trials follow."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

log = logging.getLogger(__name__)

STATE, ALARM = "state", "alarm"
"""Kinds of events: how the robot is when a trial begins; the begin or the end of an alarm."""
KEPT = 1000
"""Events that are kept for pages that open later."""


@dataclass(frozen=True)
class ConsoleEvent:
    """Something that happened."""

    stamp: float  # s of ROS time
    kind: str  # pressed, sent, ended, stopped, walked, said, heard, touched, seen, felt, state, alarm, note, ...
    robot: str  # its namespace, with a slash at both ends
    text: str  # for people
    by: str = ""  # who did it at the console; empty: the robot, or another program
    data: Mapping[str, Any] = field(default_factory=dict)  # values that JSON has


class EventStream:
    """The events of one robot. Any thread.

    `clock`: gives the ROS time, s.
    """

    def __init__(self, robot: str, clock: Callable[[], float]) -> None:
        self._robot = robot
        self._clock = clock
        self._lock = threading.Lock()
        self._events: deque[ConsoleEvent] = deque(maxlen=KEPT)
        self._listeners: dict[object, Callable[[ConsoleEvent], None]] = {}

    def add(self, kind: str, text: str, /, by: str = "", stamp: float | None = None, **data: Any) -> ConsoleEvent:
        """Something has happened, now or at `stamp`."""
        event = ConsoleEvent(self._clock() if stamp is None else stamp, kind, self._robot, text, by, data)
        with self._lock:
            self._events.append(event)
            listeners = list(self._listeners.values())
        for listener in listeners:
            try:
                listener(event)
            except Exception:  # the others, a trial's log among them, are told all the same
                log.exception("an event is lost to one who listens: %s", event)
        return event

    def subscribe(self, listener: Callable[[ConsoleEvent], None]) -> Callable[[], None]:
        """Have each event told in the thread that adds it; what comes back ends that."""
        key = object()
        with self._lock:
            self._listeners[key] = listener
        return lambda: self._forget(key)

    def last(self, count: int = 200) -> list[ConsoleEvent]:
        """The newest events, the oldest of them first."""
        with self._lock:
            return list(self._events)[-count:]

    def _forget(self, key: object) -> None:
        with self._lock:
            self._listeners.pop(key, None)


def namespace_of(name: str) -> str:
    """Of the robot of a name, with a slash at both ends."""
    return f"/{name.strip('/')}/" if name.strip("/") else "/"
