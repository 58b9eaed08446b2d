"""Topics that hold a state, and the change that is news. Pure.

Who begins to listen to a latched topic, or to a key of the robot's memory, is told the present value first. So is
everybody when the robot or the node behind the topic is back. None of that has happened just now.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from typing import Any

REACHED = frozenset({"connected", "silent"})
"""States of nao_library_msgs/ConnectionState in which the robot is known to be the one of before."""
SETTLED = 10.0
"""s of this computer after a connection is back, within which topics tell how it stands."""


class Latched:
    """The state that one topic holds. Any thread.

    Args:
        repeats: The topic holds what happened last, as a sentence or a fall: each message is news, whatever its value,
            but those that tell the present value. Otherwise only another value is news.
        clock: s of this computer.

    Attributes:
        value: The state; None until it is told.
        held: Whether the topic had a value when it was subscribed; only `repeats` needs to know.
    """

    def __init__(self, repeats: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._repeats, self._clock = repeats, clock
        self._lock = threading.Lock()
        self.clear()

    def clear(self) -> None:
        """Forget the state: nobody listens any more."""
        with self._lock:
            self.value: Any = None
            self.held = False
            self._link: Any = None
            self._heard = False
            self._state_until = -math.inf

    def take(self, value: Any, message: Any = None) -> bool:
        """Take a value that was told; whether that is news. `message`: of rospy, which knows its own connection."""
        link = getattr(message, "_connection_header", None)
        with self._lock:
            first_of_link = not self._heard or link is not self._link
            known = self._heard or self.held
            before, self.value = self.value, value
            self._link, heard, self._heard = link, self._heard, True
            if not self._repeats:
                return heard and value != before
            state = (first_of_link and known) or self._clock() < self._state_until
            self._state_until = -math.inf
            return not state

    def connection_is(self, state: str) -> None:
        """The connection to the robot changes: behind one that was lost the next message tells how it stands."""
        with self._lock:
            if state not in REACHED:
                self._state_until = math.inf
            elif self._state_until == math.inf:
                self._state_until = self._clock() + SETTLED
