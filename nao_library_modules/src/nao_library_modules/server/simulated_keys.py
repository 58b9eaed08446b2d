"""Keys of ALMemory that only a simulated robot has: what it knows and no robot tells. No ROS."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Callable

from ..functions.memory_functions import MEMORY
from ..robot.robot_clock import RobotClock

SLACK = 0.05
"""s by which times of the robot may lie before the call that they belong to: clocks are compared to a few ms."""


class SimulatedKey:
    """A key that the robot may have or not; that is asked once a connection."""

    def __init__(self, robot: Any, name: str) -> None:
        self._robot = robot
        self._name = name
        self._known = False
        self._generation = 0

    def known(self, call: Callable[..., Any]) -> bool:
        """Whether the robot has it.

        `call`: `call` of a module: proxy, method, arguments. Raises NaoError if the robot cannot be asked.
        """
        generation = self._robot.connection.generation
        if self._generation != generation:
            self._known = self._name in call(self._robot.proxy(MEMORY), "getDataList", self._name)
            self._generation = generation
        return self._known

    def value(self, call: Callable[..., Any]) -> Any:
        """What it holds. `call`: as `known` takes it. Raises NaoError if the robot cannot be asked."""
        return call(self._robot.proxy(MEMORY), "getData", self._name)

    def span(self, call: Callable[..., Any], clock: RobotClock, began: float) -> tuple[float, float]:
        """ROS times, s, from a key that holds [onset, end] of what came last, s of the robot.

        Returns both; 0 where it is something else, or there has been nothing. Raises NaoError if the robot cannot be
        asked.

        Args:
            call: As `known` takes it.
            clock: Turns times of the robot into ROS time.
            began: ROS time, s; what began before is something else.
        """
        return checked_span([clock.ros_time(call, time) for time in self.value(call)], began)


def checked_span(times: Sequence[float], began: float) -> tuple[float, float]:
    """Onset and end if they are that, and not of something that began before `began`, else 0; ROS times, s."""
    if len(times) == 2 and began - SLACK <= times[0] <= times[1]:
        return times[0], times[1]
    return 0.0, 0.0
