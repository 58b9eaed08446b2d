"""Wall-clock time whose waits can be interrupted; ros_clock has the same for ROS time."""

from __future__ import annotations

import time

from .cancellation import CancellationToken


class WallClock:
    """Time of the computer. `simulated`: whether it is the time of a simulation."""

    simulated = False

    def now(self) -> float:
        """Seconds since some fixed moment; never goes backwards."""
        return time.monotonic()

    def wait(self, duration: float, interrupt: CancellationToken) -> bool:
        """Wait, unless interrupted.

        `duration`: s, >= 0. `interrupt`: ends the wait. Returns whether the whole duration passed.
        """
        return not interrupt.wait(duration)
