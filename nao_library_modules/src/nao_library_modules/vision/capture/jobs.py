"""The streams and recordings of a server, by the names that users gave them."""

from __future__ import annotations

import logging
import threading
import time
from typing import Union

from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from .recorder import Recording
from .stream import Stream

log = logging.getLogger(__name__)

MOST_THREADS = 100
CLOSING = 2.0
"""How long the end of the server waits for frames that have come and are not written yet, s of wall-clock time."""

AnyThread = Union[Stream, Recording]


class VisionThreads:
    """A table of threads. Goals use it from one thread, the end of the node from another."""

    def __init__(self) -> None:
        """Begin without any."""
        self._lock = threading.Lock()
        self._threads: dict[str, AnyThread] = {}
        self._closed = False

    @property
    def known(self) -> dict[str, AnyThread]:
        """Name -> thread, in the order of the names; a copy."""
        with self._lock:
            return dict(sorted(self._threads.items()))

    def get(self, ident: str) -> AnyThread:
        """The thread of a name.

        Raises:
            BadGoal: If there is none.
        """
        known = self.known
        if ident not in known:
            raise unknown(ident, known)
        return known[ident]

    def add(self, thread: AnyThread) -> None:
        """Take up a thread in the place of one of the same name that does not run.

        Raises:
            BadGoal: If one of that name runs, or there are too many.
        """
        with self._lock:
            old = self._threads.get(thread.ident)
            if old is not None and old.runs:
                raise taken(thread.ident)
            if old is None and len(self._threads) >= MOST_THREADS:
                raise too_many(thread.ident)
            if self._closed:
                raise BadGoal("id", thread.ident, "none any more", problem="the server ends")
            self._threads[thread.ident] = thread
        if old is not None:
            old.stop()  # it has failed, or was never started

    def remove(self, ident: str) -> None:
        """Forget a thread; it must have been stopped."""
        with self._lock:
            self._threads.pop(ident, None)

    def close(self) -> None:
        """Stop all of them: files are complete afterwards.

        They end together, and soon: who ends the node is not patient, and what is killed has no complete file.
        """
        with self._lock:
            self._closed = True
        threads = list(self.known.values())
        running = [thread for thread in threads if thread.runs]
        for thread in threads:
            thread.let_go()
        for thread in running:
            log.info("%s %r ends with the server", thread.kind, thread.ident)
        deadline = time.monotonic() + CLOSING
        for thread in threads:
            thread.wait_until(deadline)
        for thread in threads:
            thread.stop(at_once=True)


def unknown(ident: str, known: object) -> BadGoal:
    """There is no thread of a name."""
    names = list(known)
    problem = f"there is no stream or recording {ident!r}{did_you_mean(ident, names)}"
    return BadGoal("id", ident, f"one of {', '.join(names)}" if names else "there are none", problem=problem)


def taken(ident: str) -> BadGoal:
    """A name is that of a thread that runs."""
    return BadGoal("id", ident, "stop it first, or take another name", problem=f"{ident!r} runs already")


def too_many(ident: str) -> BadGoal:
    """There is no room for a further thread."""
    problem = "there are too many streams and recordings"
    return BadGoal("id", ident, f"up to {MOST_THREADS}: deleteThread makes room", problem=problem)
