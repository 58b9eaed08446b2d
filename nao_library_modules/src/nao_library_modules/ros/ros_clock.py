"""ROS time whose waits can be interrupted, simulated time included."""

from __future__ import annotations

import rospy
from rospy.rostime import get_rostime_cond, is_wallclock

from ..base.cancellation import CancellationToken


class RosClock:
    """Wall-clock time, or the time on /clock when `use_sim_time` is set."""

    @property
    def simulated(self) -> bool:
        return not is_wallclock()

    def now(self) -> float:
        """ROS time in s."""
        return rospy.get_time()

    @staticmethod
    def wait_for_start() -> None:
        """Wait for the first message of /clock. A limit that is counted from the zero before it would be over with it.

        Raises ROSInterruptException if the node ends before.
        """
        rospy.sleep(0.0)

    def wait(self, duration: float, interrupt: CancellationToken) -> bool:
        """Wait, unless interrupted.

        `duration`: s of ROS time, >= 0. `interrupt`: ends the wait. Returns whether the whole duration passed.
        """
        if is_wallclock():
            return not interrupt.wait(duration)
        return self._wait_for_clock_messages(duration, interrupt)

    @staticmethod
    def _wait_for_clock_messages(duration: float, interrupt: CancellationToken) -> bool:
        # rospy notifies its condition on every message of /clock. Nobody calls actionlib while holding its
        # lock, so an interrupt that comes under actionlib's lock may notify it as well.
        condition = get_rostime_cond()

        def wake() -> None:
            with condition:
                condition.notify_all()

        remaining = duration
        with interrupt.waking(wake), condition:
            last = rospy.get_time()
            while remaining > 0.0 and not interrupt.is_set():
                condition.wait()
                now = rospy.get_time()
                # A step backwards is a simulation that started again: time before it counts, the jump does
                # not. Before the first message of /clock the time is zero; its arrival is a jump as well.
                if now > last > 0.0:
                    remaining -= now - last
                last = now
        return not interrupt.is_set()
