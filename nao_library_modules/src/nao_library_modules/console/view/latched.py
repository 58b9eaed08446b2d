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


class Recovery:
    """Whether the robot is lost, or came back a moment ago: what is told then is how it stands. Any thread.

    `clock`: s of this computer.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._until = -math.inf

    @property
    def lasts(self) -> bool:
        return self._clock() < self._until

    def end(self) -> None:
        """What was waited for has been told."""
        self._until = -math.inf

    def connection_is(self, state: str) -> None:
        """The connection to the robot changes. `state`: of nao_library_msgs/ConnectionState."""
        if state not in REACHED:
            self._until = math.inf
        elif self._until == math.inf:
            self._until = self._clock() + SETTLED


class Latched:
    """The state that one topic holds. Any thread.

    Args:
        repeats: The topic holds what happened last, as a sentence or a fall: each message is news, whatever its value,
            but those that tell the present value. Otherwise only another value is news.
        clock: s of this computer.

    Attributes:
        value: The state; None until it is told.
        held: Whether the topic had a value when it was subscribed; only `repeats` needs to know.
        recovery: Is told how the connection is; behind one that was lost the next message tells how it stands.
    """

    def __init__(self, repeats: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._repeats = repeats
        self.recovery = Recovery(clock)
        self._lock = threading.Lock()
        self.clear()

    def clear(self) -> None:
        """Forget the state: nobody listens any more."""
        with self._lock:
            self.value: Any = None
            self.held = False
            self._link: Any = None
            self._heard = False
            self.recovery.end()

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
            state = (first_of_link and known) or self.recovery.lasts
            self.recovery.end()
            return not state
