"""Something that is read from the robot at a steady rate, while somebody wants it. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError, RobotUnreachable

from ...base.cancellation import CancellationToken
from ...ros.health import Level, Report
from .rate import Rate
from .rate_meter import RateMeter

log = logging.getLogger(__name__)

FASTEST = 0.008
"""s of real time between two readings at least, however fast simulated time runs."""
RETRY = 0.5
"""s between two attempts to read a robot that cannot be read."""


class Polling:
    """Readings at an even rate, in a thread of its own that sleeps while nobody wants any."""

    def __init__(self, robot: Any, name: str, rate: float, clock: Any, read: Callable[[], None]) -> None:
        """Nothing is wanted yet.

        `read` asks the robot for what `name` says and hands on its answer, in the thread of this object, at `rate` Hz
        of the clock (WallClock or RosClock). Readings that are late are left out; see RateMeter for what is told then.
        """
        self._robot = robot
        self._name = name
        self._asked = rate
        self._period = 1.0 / rate
        self._clock = clock
        self._read = read
        self._interrupt = CancellationToken()  # ends a wait when nobody wants readings any more, or for good
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
            return Report(Level.OK, "nobody listens", values)
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
            except Exception as error:  # a mistake in here must not leave a node that lives and says nothing
                self._problem = f"unexpected error: {error!r}"
                log.exception("the %s cannot be read", self._name)
            self._interrupt.wait(RETRY)

    def _read_on(self) -> None:
        rate = Rate(self._clock, self._period, min(FASTEST, self._period / 2), self._interrupt)
        last = None
        self._meter.restart()  # nobody wanted any until now, or there was no robot
        while rate.wait() and self._robot.connection.state == "connected":
            now = self._clock.now()
            if now == last:
                continue  # a step of simulated time may be longer than the wait
            last = now
            self._read()
            self._problem = self._logged = ""
            self._meter.note(now, self._asked)
