"""The sonars of the chest, which measure while that is wanted. No ROS."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ...nao.body_devices import NEAREST, SONARS, echo_of
from ...ros.health import Level, Report
from ..base.lazy_subscription import LazySubscription
from ..base.polling import Polling

SONAR, MEMORY = "ALSonar", "ALMemory"


def range_of(value: Any) -> float:
    """A distance in m by REP 117, from a value of the robot's memory, see `echo_of`.

    Infinity where there is nothing, minus infinity where it is too close, NaN for a sensor that failed.
    """
    echo = echo_of(value)
    return -math.inf if echo < NEAREST else echo


class Sonars:
    """Has the robot measure while that is wanted, also after a lost connection."""

    def __init__(
        self, robot: Any, subscriber: str, rate: float, clock: Any, sink: Callable[[Mapping[str, float]], None]
    ) -> None:
        """Start idle; the robot need not be connected yet.

        Args:
            subscriber: Name of the subscriber at the robot.
            rate: Hz.
            clock: ROS time.
            sink: Gets each reading by side, in m, in a thread of its own.
        """
        self._robot = robot
        self._subscriber = subscriber
        self._sink = sink
        self._measuring = LazySubscription(
            robot, "sonars", lambda: self._ask("subscribe"), lambda: self._ask("unsubscribe")
        )
        self._polling = Polling(robot, "sonars", rate, clock, self._read)

    def want(self, wanted: bool) -> None:
        self._measuring.want(wanted)
        self._polling.want(wanted)

    def report(self) -> Report:
        report = self._polling.report()
        if self._measuring.wanted and self._measuring.problem:
            return Report(Level.ERROR, f"the sonars do not measure: {self._measuring.problem}", report.values)
        return report

    def close(self) -> None:
        self._polling.close()
        self._measuring.close()

    def _ask(self, method: str) -> None:
        self._robot.proxy(SONAR).call_async(method, self._subscriber).result(timeout=ANSWER_LIMIT)

    def _read(self) -> None:
        if not self._measuring.running:
            return  # the memory holds what was measured for somebody else, long ago
        values = self._robot.proxy(MEMORY).call_async("getListData", list(SONARS.values())).result(timeout=ANSWER_LIMIT)
        if len(values) != len(SONARS):
            raise NaoError(f"the robot's memory answers {values!r} for {', '.join(SONARS.values())}")
        self._sink({side: range_of(value) for side, value in zip(SONARS, values)})
