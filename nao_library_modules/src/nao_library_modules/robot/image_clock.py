"""Times of pictures: from the robot's clock to ROS time. No ROS."""

from __future__ import annotations

from collections import deque

WINDOW = 1.0
"""s over which the quickest picture tells how the clocks go together. A simulated robot's clock may go slower than ROS
time, when the computer has too much to do: the shorter, the sooner that is noticed."""
LEAST, OLDEST = 3, 5.0
"""Pictures that are compared however few there are in that time, unless they are older than so many s: after a pause
the clocks may go together otherwise."""
STEP = 1e-6
"""Least time between two pictures, s."""


class ImageClock:
    """Maps the robot's times of one stream to ROS time, so that they grow from picture to picture. For one thread.

    A picture comes some time after it was taken, sometimes sooner and sometimes later. The quickest of the last ones
    gives the difference of the robot's clock and ROS time.
    """

    def __init__(self) -> None:
        self._latest: deque[tuple[float, float]] = deque()  # ROS time of arrival, and robot's time before that
        self._last = (0.0, 0.0)

    def restart(self) -> None:
        """Begin another stream, whose clock may be another one."""
        self._latest.clear()

    def take(self, robot: float, now: float) -> float:
        """ROS time at which a picture was taken, s, never after its arrival.

        `robot`: robot's time at which it was taken, s. `now`: ROS time of its arrival, s.
        """
        last_robot, last_ros = self._last
        if robot < last_robot or now < last_ros:
            self._latest.clear()  # a clock was set back
        first = not self._latest
        self._latest.append((now, now - robot))
        while now - self._latest[0][0] > (WINDOW if len(self._latest) > LEAST else OLDEST):
            self._latest.popleft()
        ros = robot + min(late for _, late in self._latest)
        if not first:
            # Once in a while a picture is quicker than all before: the time steps back, but not before the last one.
            ros = max(ros, min(last_ros + STEP, now))
        self._last = (robot, ros)
        return ros
