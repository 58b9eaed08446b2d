"""A thread that is told of every stretch of simulated time that has passed: to write or send on what was played."""

from __future__ import annotations

import logging
import threading
from typing import Callable

from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.sound.timeline import Timeline

log = logging.getLogger("nao_sim.sound")

LONGEST = RATE
"""Frames of the longest stretch that is handled at once."""


class Follower:
    """Follows a timeline from now on. Made and closed in any thread.

    Args:
        name: Of the thread.
        handle: Called in the thread with (first, last): the frames `first` to `last`, without it, have passed. The
            stretches follow each other without gaps. When it raises, that is logged and nothing more is handled.
        step: How many frames pass between two calls, as long as the thread keeps up.
    """

    def __init__(self, name: str, timeline: Timeline, handle: Callable[[int, int], None], step: int) -> None:
        self._timeline = timeline
        self._handle = handle
        self._step = step
        self._next = timeline.now + step
        self._done = timeline.now
        self._news = threading.Event()
        self._closing = False
        self._name = name
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()
        timeline.add(self)

    @property
    def lag(self) -> float:
        """What has passed and was not handled, s; 0 when it has failed or is closed."""
        return (self._timeline.now - self._done) / RATE if self._thread.is_alive() else 0.0

    def close(self, timeout: float = 5.0) -> None:
        """Handle what has passed, and end; waits for that (wall time, s)."""
        self._closing = True
        self._news.set()
        self._thread.join(timeout)

    def next_due(self) -> int | None:
        """See Due; simulation thread."""
        return self._next if self._thread.is_alive() else None

    def work(self, frame: int) -> None:
        """See Due; simulation thread."""
        if frame >= self._next:
            self._next = frame + self._step
            self._news.set()

    def _run(self) -> None:
        try:
            while not self._closing:
                self._news.wait()
                self._news.clear()
                while self._done < self._timeline.now:
                    last = min(self._timeline.now, self._done + LONGEST)
                    self._handle(self._done, last)
                    self._done = last
        except Exception:
            log.exception("%s has ended", self._name)
