"""The clock of sound, what is due on it, and threads that follow it. Simulation thread only, but for `now`."""

from __future__ import annotations

import logging
import threading
from typing import Callable, Protocol

from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.base.samples import RATE

NEVER = 2**62
HOUSEKEEPING = RATE
"""Frames between two looks at what nobody can ask for any more."""
log = logging.getLogger("nao_sim.sound")

LONGEST = RATE
"""Frames of the longest stretch that is handled at once."""


class Due(Protocol):
    """Something that has work to do at certain frames."""

    def next_due(self) -> int | None:
        """The next frame at which there is work; None when there is none."""

    def work(self, frame: int) -> None:
        """Do what is due up to `frame`."""


class Alarm:
    """Has something called at a time. Simulation thread."""

    def __init__(self, frame: int, call: Callable[[], None]) -> None:
        self._frame = frame
        self._call: Callable[[], None] | None = call

    def next_due(self) -> int | None:
        """The time, until it has come."""
        return self._frame if self._call is not None else None

    def work(self, frame: int) -> None:
        if self._call is not None and frame >= self._frame:
            call, self._call = self._call, None
            call()


class Timeline:
    """Simulated time in frames; `keep` s of it are remembered. A tick without work costs one comparison.

    What is before the frame of `now` is past and never changes. Functions in `forget` are called with a frame now and
    then: what was over before it may be forgotten.
    """

    def __init__(self, keep: float, guard: Guard) -> None:
        self._guard = guard
        self.now = 0
        self.forget: list[Callable[[int], None]] = []
        self._keep = round(keep * RATE)
        self._active: list[Due] = []
        self._next = 0
        self._housekeeping = 0

    @property
    def oldest(self) -> int:
        """The first frame that is still known."""
        return max(0, self.now - self._keep)

    def add(self, item: Due) -> None:
        """Look after `item` until it has nothing due any more."""
        if item not in self._active:
            self._active.append(item)
        self._next = min(self._next, self.now)

    def tick(self, frame: int) -> None:
        """Time has come to `frame`."""
        self.now = frame
        if frame >= self._next:
            self._work(frame)

    def _work(self, frame: int) -> None:
        for item in list(self._active):
            self._guard.call(item.work, frame)
        due = {item: item.next_due() for item in self._active}
        self._active = [item for item, at in due.items() if at is not None]
        if frame >= self._housekeeping:
            self._housekeeping = frame + HOUSEKEEPING
            for forget in self.forget:
                self._guard.call(forget, self.oldest)
        self._next = min([self._housekeeping, *(at for at in due.values() if at is not None)])


class Follower:
    """A thread that is told of every stretch of a timeline that passes: to write or send on what was played.

    It calls `handle` with (first, last): the frames `first` to `last`, without it, have passed, `step` of them as long
    as it keeps up. The stretches follow each other without gaps. When it raises, that is logged and nothing more is
    handled. Made and closed in any thread.
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
