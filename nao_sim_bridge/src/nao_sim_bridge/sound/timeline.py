"""The clock of sound, and what is due on it. Simulation thread only, but for `now`."""

from __future__ import annotations

from typing import Callable, Protocol

from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.base.samples import RATE

NEVER = 2**62
HOUSEKEEPING = RATE
"""Frames between two looks at what nobody can ask for any more."""


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

    Attributes:
        now: The frame of now: what is before it is past and never changes; any thread may read it.
        forget: Called with a frame now and then: what was over before it may be forgotten.
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
