"""Tracks what is inside libqi, so that a program can end safely.

A thread that returns from libqi's C++ code while the interpreter is being finalised kills the whole process.
Closing a session makes all threads return; its owner waits for that here.
"""

from __future__ import annotations

import sys
import threading
import time
import weakref
from typing import Any, Dict, Hashable, List

STRAND = "__qi_strand__"
"""Attribute in which libqi keeps the queue that serialises the calls of an object."""
POLL_PERIOD = 0.002
"""Period in s of `wait_until_empty`: the loss of a reference raises no event."""


class Presence:
    """Threads that wait in libqi, callbacks that libqi still has to call, and objects of ours that it serves."""

    def __init__(self) -> None:
        self._inside: Dict[Hashable, None] = {}  # a dictionary: its single operations need no lock
        self._served: List[List[Any]] = []
        self._left = threading.Condition()  # guards the list above, and wakes waiting threads
        self._awaited = False

    def enter(self, who: Hashable) -> None:
        """Note an entry; runs at each call, so it must stay cheap."""
        self._inside[who] = None

    def leave(self, who: Hashable) -> None:
        """Note a return; one without an entry is no error."""
        self._inside.pop(who, None)
        if self._awaited:
            with self._left:
                self._left.notify_all()

    def lend(self, callback: Any) -> None:
        """Track a callback that libqi holds, until its last reference is gone."""
        self.enter(weakref.ref(callback, self.leave))

    def serve(self, served: Any) -> None:
        """Track an object that libqi serves, and keep a reference to it until libqi drops its own.

        Deleting the object waits for its queue. In a thread of libqi, at the end of the program, that would be fatal;
        so the last reference stays here, and is dropped in a thread of ours.
        """
        with self._left:
            self._served = [each for each in self._served if not _is_ours_alone(each)]
            self._served.append([served])

    def wait_until_empty(self, limit: float) -> bool:
        """Wait until all threads but the calling one have returned and libqi serves no objects any more.

        `limit`: longest wait, in s. Returns whether that was reached.
        """
        self._awaited = True
        end = time.monotonic() + limit
        own = threading.get_ident()
        with self._left:
            while True:
                self._served = [each for each in self._served if not _is_ours_alone(each)]
                if not self._served and all(each == own for each in tuple(self._inside)):
                    return True
                left = end - time.monotonic()
                if left <= 0.0:
                    return False
                self._left.wait(min(left, POLL_PERIOD) if self._served else left)


def _is_ours_alone(holder: List[Any]) -> bool:
    """Whether the list holds the only reference to its one object, and the object the only one to its queue."""
    if sys.getrefcount(holder[0]) > _FROM_A_LIST:
        return False
    strand = vars(holder[0]).get(STRAND)
    return strand is None or sys.getrefcount(strand) <= _FROM_A_VARIABLE_AND_A_DICT


def _count_from_a_list(holder: List[Any]) -> int:
    return sys.getrefcount(holder[0])


def _count_from_a_variable_and_a_dict(values: Dict[str, Any]) -> int:
    value = values.get(STRAND)
    return sys.getrefcount(value)


# Measured, because reference counts differ between Python versions.
_FROM_A_LIST = _count_from_a_list([object()])
_FROM_A_VARIABLE_AND_A_DICT = _count_from_a_variable_and_a_dict({STRAND: object()})
