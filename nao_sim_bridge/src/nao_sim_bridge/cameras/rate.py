"""When frames fall due, in exact arithmetic: no rate drifts, and ticks are whole. Pure."""

from __future__ import annotations

import math
from fractions import Fraction


def exact_rate(rate: float) -> Fraction:
    """Frames a second as a fraction; what was meant by a float such as 0.1 or 1000 / 300."""
    return Fraction(rate).limit_denominator(10000)


class Shutter:
    """The times at which a camera takes pictures: every 1 / rate from a tick on, each at the nearest tick.

    Attributes:
        rate: Frames a second; 0 while nobody wants any.
        next_tick: The tick of the next frame; a number beyond all ticks while there is none.
    """

    NEVER = 1 << 62

    def __init__(self, ticks_per_second: Fraction) -> None:
        self._ticks_per_second = ticks_per_second
        self._origin = Fraction(0)
        self._count = 0
        self.rate = Fraction(0)
        self.next_tick = self.NEVER

    @property
    def next_time(self) -> Fraction:
        """Exact time of the next frame, in ticks."""
        return self._origin + self._count * self._ticks_per_second / self.rate

    def set_rate(self, rate: Fraction, now: int) -> None:
        """Take so many pictures a second from now on.

        A camera that begins to run has its first frame at the tick after `now`; one that runs goes on from its last.
        """
        if rate == self.rate:
            return
        if self.rate and rate and self._count == 0:
            self._origin = max(self._origin, Fraction(now + 1))
        elif self.rate and rate:
            # From the last frame on, so that slower streams that divide the rate go on as before.
            last, period = self.next_time - self._ticks_per_second / self.rate, self._ticks_per_second / rate
            self._origin, self._count = last, max(1, math.ceil((now + Fraction(1, 2) - last) / period))
        else:
            self._origin, self._count = Fraction(now + 1), 0
        self.rate = rate
        self._aim()

    def advance(self, tick: int) -> Fraction:
        """The frame of this tick has been taken; returns its exact time in ticks."""
        taken = self.next_time
        self._count += 1
        self._aim()
        while self.next_tick <= tick:  # ticks that nobody looked at, as after a camera was stopped
            self._count += 1
            self._aim()
        return taken

    def _aim(self) -> None:
        self.next_tick = math.floor(self.next_time + Fraction(1, 2)) if self.rate else self.NEVER


class Share:
    """Which frames of a camera one stream gets: those that come when 1 / rate has passed since its beginning."""

    def __init__(self, rate: Fraction, ticks_per_second: Fraction) -> None:
        self._ticks_per_second = ticks_per_second
        self._origin: Fraction | None = None
        self._count = 0
        self.rate = rate

    def takes(self, time: Fraction) -> bool:
        """Whether the stream gets a frame with this exact time, in ticks; asked once for each."""
        if self._origin is None:
            self._origin = time
        period = self._ticks_per_second / self.rate
        due = self._origin + self._count * period
        if time < due:
            return False
        self._count = math.floor((time - self._origin) / period) + 1
        return True
