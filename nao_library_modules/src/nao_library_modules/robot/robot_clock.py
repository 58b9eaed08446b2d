"""The ROS time of an event, from the robot's clock. No ROS."""

from __future__ import annotations

import threading
from typing import Any, Callable

CLOCKS_AGREE = 5.0
"""s between the robot's clock and simulated ROS time; more, and it is another clock. Ours may be a little late."""
SAMPLES = 12
"""Looks at the robot's clock that are compared at once: together longer than a tick of a simulated one."""
FRESH = 60.0
"""s for which a comparison holds; clocks that nobody keeps together drift by a few milliseconds in that time."""
JUMP = 0.03
"""s by which a clock must be off what is known of it to be compared anew at once: one that was set, that of a simulated
robot that began anew, or whose computer is too slow for it."""
KEY = "nao_library/Clock"
"""A key of ALMemory that is written to learn the robot's time from its timestamp."""


def same_clock(robot_time: float, now: float) -> bool:
    """Whether a recent time of the robot is one of simulated ROS time, `now`; both in s."""
    return abs(now - robot_time) <= CLOCKS_AGREE


def _mapped(time: float, latest: float) -> float:
    """A computed time, s: none after `latest`, and none below 0, where simulated time begins."""
    return max(0.0, min(time, latest))


class RobotClock:
    """Maps timestamps of the robot's ALMemory to ROS time. Any thread.

    A simulated robot whose clock is the simulated ROS time has nothing to map. With any other robot the clocks are
    compared when a time is asked for: a key is written several times, and was written between call and answer each
    time, which gives the difference of the clocks to half of the quickest write. A simulated robot's clock goes in
    ticks, which shows as times that contradict each other: then the write soonest after a tick counts. A robot behind
    another connection is compared anew.

    All methods take times in s, and `call`, the method of a module that calls a proxy: proxy, method, arguments. They
    raise NaoError if the robot cannot be asked.
    """

    def __init__(self, robot: Any, clock: Any) -> None:
        self._robot = robot
        self._clock = clock
        self._lock = threading.Lock()
        self._offset: tuple[float, float, int] | None = None  # s; when it was found, and in which connection

    def event_time(self, call: Callable[..., Any], event: str, value: Any, arrived: float) -> float:
        """ROS time at which an event was raised last, if its last value is this one; otherwise that of its arrival.

        `EventTimes` knows the times of those before.
        """
        last, seconds, microseconds = call(self._robot.proxy("ALMemory"), "getTimestamp", event)
        return arrived if last != value else self.raised(call, seconds + 1e-6 * microseconds, arrived)

    def raised(self, call: Callable[..., Any], robot_time: float, arrived: float) -> float:
        """ROS time of a time on the robot at which something was raised that arrived here at `arrived`."""
        if self._is_ours(robot_time):  # exact, while the time of arrival may be late
            return robot_time
        return min(self.ros_time(call, robot_time), arrived)

    def ros_time(self, call: Callable[..., Any], robot_time: float) -> float:
        """ROS time of a time on the robot; later than now only where now is late: /clock is on its way, too."""
        if self._is_ours(robot_time):
            return robot_time
        now = self._clock.now()
        return _mapped(robot_time + self._offset_at(call, now), now)

    def _is_ours(self, robot_time: float) -> bool:
        return self._clock.simulated and same_clock(robot_time, self._clock.now())

    def compare(self, call: Callable[..., Any]) -> None:
        """Have `mapped` know the robot's clock, where ROS time is not simulated."""
        if not self._clock.simulated:
            self._offset_at(call, self._clock.now())

    def mapped(self, robot_time: float, arrived: float) -> float:
        """As `ros_time`, without asking the robot: for threads that must not wait.

        Where the clocks have not been compared it is the ROS time of arrival.
        """
        if self._is_ours(robot_time):
            return robot_time
        with self._lock:
            known = self._offset
        if known is None or known[2] != self._robot.connection.generation:
            return arrived
        return _mapped(robot_time + known[0], arrived)

    def _offset_at(self, call: Callable[..., Any], now: float) -> float:
        generation = self._robot.connection.generation
        with self._lock:
            known = self._offset
        if known is not None and 0.0 <= now - known[1] <= FRESH and known[2] == generation:
            least, most = self._look(call)
            if least - JUMP <= known[0] <= most + JUMP:
                return known[0]
        looks = [self._look(call) for _ in range(SAMPLES)]
        least, most = max(low for low, _ in looks), min(high for _, high in looks)
        offset = (least + most) / 2.0 if least <= most else most
        with self._lock:
            self._offset = (offset, now, generation)
        return offset

    def _look(self, call: Callable[..., Any]) -> tuple[float, float]:
        """ROS time less the robot's, s, at least and at most."""
        before = self._clock.now()
        call(self._robot.proxy("ALMemory"), "insertData", KEY, before)
        after = self._clock.now()
        stamp = self._written(call)
        return before - stamp, after - stamp

    def robot_time(self, call: Callable[..., Any]) -> float:
        """The robot's time at some moment of the call."""
        call(self._robot.proxy("ALMemory"), "insertData", KEY, self._clock.now())
        return self._written(call)

    def _written(self, call: Callable[..., Any]) -> float:
        """The robot's time at which the key was written last."""
        _, seconds, microseconds = call(self._robot.proxy("ALMemory"), "getTimestamp", KEY)
        return seconds + 1e-6 * microseconds
