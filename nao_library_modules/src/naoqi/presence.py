"""Who is inside libqi, so that a program can end without pulling the floor from under them.

A thread that comes out of libqi's C++ code while the interpreter is being taken down kills the whole process.
Closing a session makes everybody come out; this is how its owner waits for that.
"""

from __future__ import annotations

import threading
import weakref
from typing import Any, Dict, Hashable


class Presence:
    """Threads that wait in libqi, and objects of ours that it holds and will let go of in a thread of its own."""

    def __init__(self) -> None:
        """Nobody is inside."""
        self._inside: Dict[Hashable, None] = {}  # a dictionary, because its single steps need no lock
        self._left = threading.Condition()
        self._awaited = False

    def enter(self, who: Hashable) -> None:
        """Somebody goes in; done at each call, hence this cheap."""
        self._inside[who] = None

    def lend(self, held: Any) -> None:
        """Libqi holds this object from now on; it has left when nobody holds it any more."""
        self.enter(weakref.ref(held, self.leave))

    def leave(self, who: Hashable) -> None:
        """Somebody has come out; who was never in is no error."""
        self._inside.pop(who, None)
        if self._awaited:
            with self._left:
                self._left.notify_all()

    def wait_until_empty(self, limit: float) -> bool:
        """Wait for everybody but the calling thread to come out.

        Args:
            limit: Longest wait, in s.

        Returns:
            Whether they have.
        """
        self._awaited = True
        own = threading.get_ident()
        with self._left:
            return self._left.wait_for(lambda: not [each for each in tuple(self._inside) if each != own], limit)
