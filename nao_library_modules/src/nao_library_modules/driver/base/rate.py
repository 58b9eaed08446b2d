"""A cycle that keeps its period: delays of one round are not handed on to the next."""

from __future__ import annotations

from typing import Any

from ...base.cancellation import CancellationToken
from ...base.clock import WallClock


class Rate:
    """Waits for the next moment of a cycle of `period` s on a clock. For one thread.

    On simulated time that runs faster than real time, rounds are at least `rest` s of real time apart: the program
    would do nothing else. The interrupt ends a wait.
    """

    def __init__(self, clock: Any, period: float, rest: float, interrupt: CancellationToken) -> None:
        self._clock = clock
        self._period = period
        self._rest = rest
        self._interrupt = interrupt
        self._wall = WallClock()
        self._next: float | None = None
        self._last_wall = self._wall.now() - rest

    def wait(self) -> bool:
        """Wait for the next moment; missed ones are left out. False if the interrupt came first."""
        now = self._clock.now()
        if self._next is None or abs(self._next - now) > 1.5 * self._period:
            self._next = now  # the first round, or one after a break; also when the clock was set back
        if self._next > now and not self._clock.wait(self._next - now, self._interrupt):
            return False
        rest = self._last_wall + self._rest - self._wall.now()
        if rest > 0.0 and not self._wall.wait(rest, self._interrupt):
            return False
        self._last_wall = self._wall.now()
        self._next += self._period
        return not self._interrupt.is_set()
