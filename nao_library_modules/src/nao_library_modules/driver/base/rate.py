"""A cycle that keeps its period: delays of one round are not handed on to the next."""

from __future__ import annotations

from typing import Any

from ...base.cancellation import CancellationToken
from ...base.clock import WallClock


class Rate:
    """Waits for the next moment of a cycle. For one thread.

    On simulated time that runs faster than real time, rounds do not follow each other faster than `rest` allows in
    real time: the program would do nothing else.
    """

    def __init__(self, clock: Any, period: float, rest: float, interrupt: CancellationToken) -> None:
        """Begin the cycle with the first wait.

        Args:
            clock: WallClock or RosClock.
            period: s between two moments, on that clock.
            rest: s of real time between two moments at least.
            interrupt: Ends a wait.
        """
        self._clock = clock
        self._period = period
        self._rest = rest
        self._interrupt = interrupt
        self._wall = WallClock()
        self._next: float | None = None
        self._last_wall = self._wall.now() - rest

    def wait(self) -> bool:
        """Wait for the next moment; moments that have passed already are left out.

        Returns:
            Whether it came; False if the interrupt came first.
        """
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
