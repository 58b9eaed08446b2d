"""One thread that carries out jobs in the order in which they came.

Callbacks must not run in libqi's own threads: there are only a few of them, and they also carry the answers
that a callback may be waiting for.
"""

from __future__ import annotations

import logging
import queue
import threading
from typing import Callable, Optional

logger = logging.getLogger("naoqi")


class Worker:
    """A queue of jobs and the thread that works it off; the thread starts with the first job."""

    def __init__(self, name: str) -> None:
        """Make an idle worker. `name`: of its thread, for logs and debuggers."""
        self.name = name
        self._jobs: queue.SimpleQueue[Optional[Callable[[], None]]] = queue.SimpleQueue()
        self._lock = threading.Lock()  # guards the two below
        self._thread: Optional[threading.Thread] = None
        self._closed = False

    def submit(self, job: Callable[[], None]) -> bool:
        """Have a job done after those that wait already.

        `job`: called without arguments in the thread of the worker; what it raises is logged. Returns whether it was
        taken; False after `close`.
        """
        with self._lock:
            if self._closed:
                return False
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name=self.name, daemon=True)
                self._thread.start()
            self._jobs.put(job)
        return True

    def close(self, timeout: float = 0.0) -> None:
        """Take no more jobs, and end the thread after those it has.

        `timeout`: how long to wait for its end, in s. A job may close its own worker; then nobody waits.
        """
        with self._lock:
            self._closed = True
            thread = self._thread
        self._jobs.put(None)
        if thread is not None and thread is not threading.current_thread():
            thread.join(timeout)

    def _work(self) -> None:
        while True:
            job = self._jobs.get()
            if job is None:
                return
            try:
                job()
            except BaseException:  # a callback may call sys.exit(): the thread serves others too
                logger.exception("a callback in %s failed", self.name)
            # While this thread waits, it must hold nothing of libqi's: the end of the program would delete it
            # with the frame of this thread, too late for libqi.
            job = None
