"""Times of pictures: from the robot's clock to ROS time. No ROS."""

from __future__ import annotations

DRIFT = 1e-4
"""How fast one clock may run away from the other: s a second."""
LATENESS = 2.0
"""s by which a picture may come later than the quickest ones; from there on, one of the clocks was set."""
STEP = 1e-6
"""Least time between two pictures, s."""


class ImageClock:
    """Maps the robot's times of one stream to ROS time, so that they grow from picture to picture. For one thread.

    A picture comes some time after it was taken, sometimes sooner and sometimes later. The quickest ones tell how the
    robot's clock and ROS time go together.
    """

    def __init__(self) -> None:
        """Begin a stream."""
        self._offset: float | None = None
        self._last = (0.0, 0.0)

    def restart(self) -> None:
        """Begin another stream, whose clock may be another one."""
        self._offset = None

    def take(self, robot: float, now: float) -> float:
        """ROS time of the next picture.

        Args:
            robot: Robot's time at which it was taken, s.
            now: ROS time of its arrival, s.

        Returns:
            ROS time at which it was taken, s; never after its arrival.
        """
        late = now - robot
        last_robot, last_ros = self._last
        if self._offset is None or robot < last_robot or late - self._offset > LATENESS or now < last_ros:
            self._offset, ros = late, now  # the first one, or a clock was set
        else:
            self._offset = min(late, self._offset + DRIFT * (robot - last_robot))
            # Once in a while a picture is quicker than all before: the time steps back, but not before the last one.
            ros = max(robot + self._offset, min(last_ros + STEP, now))
        self._last = (robot, ros)
        return ros
