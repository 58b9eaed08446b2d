"""Reading the robot at a steady rate while it is wanted, and measuring that rate. No ROS."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError, RobotUnreachable

from ...core.health import Level, Report
from ...core.waiting import CancellationToken, WallClock

log = logging.getLogger(__name__)


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


WINDOW = 3.0
"""s that the rate is measured over."""
SLOW, SLOW_FOR = 0.8, 3.0
"""Share of the rate asked for below which it is not kept, and how long it stays there, s, until that is logged."""
KEPT, KEPT_FOR = 0.9, 10.0
"""Share from which on it is kept again, and how long, s, until that is logged: a rate at a bound does not flap."""
GAP = 1.5
"""Periods between two of them from which on some are missing."""


class RateMeter:
    """Counts what comes at a rate, and logs once when the rate is not kept, and once when it is again.

    The source leaves out what it cannot deliver in time. All times are those of one clock: ROS time, or the
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
        self._reset()

    def restart(self) -> None:
        """Begin another stream: the time until the next one comes is no gap, and the former stream is not judged."""
        with self._lock:
            self._reset()

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
        if news:  # without the lock: handlers of the log may take their time
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

    def _reset(self) -> None:
        self._times: deque[float] = deque()
        self._slow = False
        self._since: float | None = None  # when the rate began to be other than what was logged last, s

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


FASTEST = 0.008
"""s of real time between two readings at least, however fast simulated time runs."""
RETRY = 0.5
"""s between two attempts to read a robot that cannot be read."""


class Polling:
    """Readings at an even rate, in a thread of its own that sleeps while none are wanted."""

    def __init__(self, robot: Any, name: str, rate: float, clock: Any, read: Callable[[], None]) -> None:
        """Nothing is wanted yet.

        `read` asks the robot for what `name` says and hands on its answer, in the thread of this object, at `rate` Hz
        of the clock (WallClock or RosClock). Readings that are late are left out; RateMeter logs that.
        """
        self._robot = robot
        self._name = name
        self._asked = rate
        self._period = 1.0 / rate
        self._clock = clock
        self._read = read
        self._interrupt = CancellationToken()  # ends a wait when readings are no longer wanted, or for good
        self._condition = threading.Condition()
        self._wanted = False
        self._closed = False
        self._meter = RateMeter(name, "readings")
        self._problem = ""
        self._logged = ""
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def want(self, wanted: bool) -> None:
        """Read, or not, from now on. Any thread."""
        with self._condition:
            self._wanted = wanted
            self._interrupt.clear() if wanted else self._interrupt.trigger()
            self._condition.notify_all()

    def report(self) -> Report:
        values = {
            "asked for every (ms)": f"{1000 * self._period:.0f}",
            **self._meter.values(self._asked),
            "readings": str(self._meter.count),
            "missed readings": str(self._meter.missed),
        }
        if not self._wanted:
            return Report(Level.OK, "no subscriber", values)
        if self._problem:
            return Report(Level.ERROR, f"the {self._name} cannot be read: {self._problem}", values)
        slow = self._meter.problem(self._asked)
        return Report(Level.WARN, slow, values) if slow else Report(Level.OK, "read", values)

    def close(self, limit: float = 2.0) -> None:
        """Read no more; waits up to `limit` s for the thread."""
        with self._condition:
            self._closed, self._wanted = True, False
            self._interrupt.stop()
            self._condition.notify_all()
        self._thread.join(limit)

    # --- the thread -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while True:
            with self._condition:
                self._condition.wait_for(lambda: self._wanted or self._closed)
                if self._closed:
                    return
            try:
                if self._robot.connection.wait_connected(RETRY):
                    self._read_on()
                    continue
                self._problem = "the robot is not connected"
            except RobotUnreachable as error:
                self._problem = str(error)  # the log has it already, from the connection
            except NaoError as error:
                self._problem = str(error)
                if self._problem != self._logged:  # of several in a row only the first
                    log.warning("the %s cannot be read: %s", self._name, self._problem)
                    self._logged = self._problem
            except Exception as error:  # a mistake in here must not leave a node that runs and publishes nothing
                self._problem = f"unexpected error: {error!r}"
                log.exception("the %s cannot be read", self._name)
            self._interrupt.wait(RETRY)

    def _read_on(self) -> None:
        rate = Rate(self._clock, self._period, min(FASTEST, self._period / 2), self._interrupt)
        last = None
        self._meter.restart()  # none were wanted until now, or the robot was not connected
        while rate.wait() and self._robot.connection.state == "connected":
            now = self._clock.now()
            if now == last:
                continue  # a step of simulated time may be longer than the wait
            last = now
            self._read()
            self._problem = self._logged = ""
            self._meter.note(now, self._asked)
