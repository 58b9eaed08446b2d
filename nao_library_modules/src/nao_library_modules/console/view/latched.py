"""Latched topics: which messages are news, and which only repeat the state. Pure.

A latched topic, or a key of the robot's memory, first sends its present value to a new subscriber. It sends the value
again when the robot has been reconnected or the node behind the topic has restarted. Neither is an event.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from typing import Any

CONNECTED = frozenset({"connected", "silent"})
"""States of nao_library_msgs/ConnectionState in which the robot is known to be the one of before."""
SETTLED = 10.0
"""s of this computer after a connection is back, within which topics send their present state."""


class Recovery:
    """Whether the robot is lost or has just been reconnected: the next message is a state then. Any thread.

    `clock`: s of this computer.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._until = -math.inf

    @property
    def lasts(self) -> bool:
        return self._clock() < self._until

    def end(self) -> None:
        """The state has arrived."""
        self._until = -math.inf

    def connection_is(self, state: str) -> None:
        """The connection to the robot changes. `state`: of nao_library_msgs/ConnectionState."""
        if state not in CONNECTED:
            self._until = math.inf
        elif self._until == math.inf:
            self._until = self._clock() + SETTLED


class Latched:
    """The state of one latched topic. Any thread.

    Args:
        repeats: The topic holds the last event, as a sentence or a fall: each message is news, whatever its value,
            unless it only repeats the present one. Otherwise only a changed value is news.
        clock: s of this computer.

    Attributes:
        value: The state; None before the first message.
        held: Whether the topic had a value when it was subscribed; only `repeats` needs to know.
        recovery: Takes the state of the connection; after a lost one the next message is a state.
    """

    def __init__(self, repeats: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._repeats = repeats
        self.recovery = Recovery(clock)
        self._lock = threading.Lock()
        self.clear()

    def clear(self) -> None:
        """Forget the state, at the end of the subscription."""
        with self._lock:
            self.value: Any = None
            self.held = False
            self._link: Any = None
            self._heard = False
            self.recovery.end()

    def take(self, value: Any, message: Any = None) -> bool:
        """Take the value of a message; whether it is news. `message`: of rospy, with the header of its connection."""
        link = getattr(message, "_connection_header", None)
        with self._lock:
            first_of_link = not self._heard or link is not self._link
            known = self._heard or self.held
            before, self.value = self.value, value
            self._link, heard, self._heard = link, self._heard, True
            if not self._repeats:
                return heard and value != before
            state = (first_of_link and known) or self.recovery.lasts
            self.recovery.end()
            return not state
