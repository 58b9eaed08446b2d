"""How often something comes, beside how often it should. No ROS."""

from __future__ import annotations

import logging
import threading
from collections import deque

log = logging.getLogger(__name__)

WINDOW = 3.0
"""s that the rate is measured over."""
SLOW, SLOW_FOR = 0.8, 3.0
"""Share of the rate asked for below which it is not kept, and how long it has to stay there, s, until that is told."""
KEPT, KEPT_FOR = 0.9, 10.0
"""Share from which on it is kept again, and how long, s, until that is told: a rate at a bound does not flap."""
GAP = 1.5
"""Periods between two of them from which on some are missing."""


class RateMeter:
    """Counts what comes at a rate, and says once in the log when the rate is not kept, and once when it is again.

    Whoever delivers it leaves out what it cannot deliver in time. All times are those of one clock: ROS time, or the
    robot's. Any thread may call.

    Attributes:
        count: How many have come.
        missed: How many should have come in between and have not.
    """

    def __init__(self, name: str, what: str) -> None:
        """Nothing has come yet. `name`: of the source; `what`: of the things that come, in the plural."""
        self.count = 0
        self.missed = 0
        self._name = name
        self._what = what
        self._lock = threading.Lock()
        self._begin_anew()

    def restart(self) -> None:
        """Begin another stream: the time until the next one comes is no gap, and nothing is told of the former."""
        with self._lock:
            self._begin_anew()

    def note(self, time: float, asked: float) -> None:
        """Count one that came at `time`, s; `asked`, Hz, is the rate that should be kept."""
        with self._lock:
            if self._times and time < self._times[-1]:  # the clock was set back
                self._times.clear()
                self._since = None
            since = time - self._times[-1] if self._times else 0.0
            if since > GAP / asked:
                self.missed += round(since * asked) - 1
            self.count += 1
            self._times.append(time)
            while self._times[-1] - self._times[0] > WINDOW and len(self._times) > 2:
                self._times.popleft()
            news = self._judge(time, asked)
        if news:  # without the lock: who listens to the log may take its time
            log.log(*news)

    @property
    def rate(self) -> float | None:
        """How many come a second; None until a second has been seen."""
        with self._lock:
            return self._rate()

    def values(self, asked: float) -> dict[str, str]:
        """Facts for /diagnostics: the rate reached beside the rate asked for, both in Hz."""
        rate = self.rate
        return {"rate asked for (1/s)": f"{asked:g}", "rate reached (1/s)": "" if rate is None else f"{rate:.1f}"}

    def problem(self, asked: float) -> str:
        """That the rate is not kept, in words; empty while it is."""
        with self._lock:
            return self._words(self._rate(), asked) if self._slow else ""

    # --- under the lock -------------------------------------------------------------------------------------------

    def _begin_anew(self) -> None:
        self._times: deque[float] = deque()
        self._slow = False
        self._since: float | None = None  # when the rate began to be other than what was told last, s

    def _rate(self) -> float | None:
        span = self._times[-1] - self._times[0] if self._times else 0.0
        return (len(self._times) - 1) / span if span >= 1.0 else None

    def _judge(self, time: float, asked: float) -> tuple[int, str] | None:
        """What is to be logged, if anything."""
        rate = self._rate()
        if rate is None or (rate < KEPT * asked if self._slow else rate >= SLOW * asked):
            self._since = None
            return None
        if self._since is None:
            self._since = time
        if time - self._since < (KEPT_FOR if self._slow else SLOW_FOR):
            return None
        self._slow, self._since = not self._slow, None
        if self._slow:
            return logging.WARNING, f"{self._name}: {self._words(rate, asked)}: what is late is left out"
        return logging.INFO, f"{self._name}: {rate:.1f} of {asked:g} {self._what} a second come again"

    def _words(self, rate: float | None, asked: float) -> str:
        return f"only {0.0 if rate is None else rate:.1f} of {asked:g} {self._what} a second"
