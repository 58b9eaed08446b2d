"""Who is inside libqi, so that a program can end without pulling the floor from under them.

A thread that comes out of libqi's C++ code while the interpreter is being taken down kills the whole process.
Closing a session makes everybody come out; this is how its owner waits for that.
"""

from __future__ import annotations

import sys
import threading
import time
import weakref
from typing import Any, Dict, Hashable, List

STRAND = "__qi_strand__"
"""Where libqi keeps the queue that makes it call an object from one thread at a time."""
POLL_PERIOD = 0.002
"""Nobody announces that a reference has gone, so `wait_until_empty` looks this often, in s."""


class Presence:
    """Threads that wait in libqi, callbacks it still has to call, and objects of ours that it serves."""

    def __init__(self) -> None:
        """Nobody is inside."""
        self._inside: Dict[Hashable, None] = {}  # a dictionary, because its single steps need no lock
        self._served: List[List[Any]] = []
        self._left = threading.Condition()  # guards the list above, and wakes who waits
        self._awaited = False

    def enter(self, who: Hashable) -> None:
        """Somebody goes in; done at each call, hence this cheap."""
        self._inside[who] = None

    def leave(self, who: Hashable) -> None:
        """Somebody has come out; who was never in is no error."""
        self._inside.pop(who, None)
        if self._awaited:
            with self._left:
                self._left.notify_all()

    def lend(self, callback: Any) -> None:
        """Libqi holds this callback from now on; it has left when nobody holds it any more."""
        self.enter(weakref.ref(callback, self.leave))

    def serve(self, served: Any) -> None:
        """Libqi serves this object from now on; it is kept until libqi does so no more.

        Its queue is waited for when it is deleted. In a thread of libqi, at the end of the program, that would
        be fatal; so the last reference stays here, and goes in a thread of ours.
        """
        with self._left:
            self._served = [each for each in self._served if not _is_ours_alone(each)]
            self._served.append([served])

    def wait_until_empty(self, limit: float) -> bool:
        """Wait for everybody but the calling thread to come out, and for libqi to drop what it serves.

        Args:
            limit: Longest wait, in s.

        Returns:
            Whether that has come true.
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
    """Whether a list is the only one that holds its one object, and the object the only one that holds its queue."""
    if sys.getrefcount(holder[0]) > _FROM_A_LIST:
        return False
    strand = vars(holder[0]).get(STRAND)
    return strand is None or sys.getrefcount(strand) <= _FROM_A_VARIABLE_AND_A_DICT


def _count_from_a_list(holder: List[Any]) -> int:
    return sys.getrefcount(holder[0])


def _count_from_a_variable_and_a_dict(values: Dict[str, Any]) -> int:
    value = values.get(STRAND)
    return sys.getrefcount(value)


# Measured, because Python versions differ in what they count.
_FROM_A_LIST = _count_from_a_list([object()])
_FROM_A_VARIABLE_AND_A_DICT = _count_from_a_variable_and_a_dict({STRAND: object()})
