"""ROS time whose waits can be interrupted, and where frames of /tf are, seen from the robot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion
from rospy.rostime import get_rostime_cond, is_wallclock

from naoqi.errors import NaoError

from ..core.geometry import FOOTPRINT, Place, from_roll_pitch_yaw, yaw_of_quaternion
from ..core.lazy import Later
from ..core.waiting import CancellationToken


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


tf2_ros = Later("tf2_ros")  # who has only the time of ROS does without

PATIENCE = 2.0
"""s that a frame may take to appear: a listener that has just begun knows nothing yet."""


class RobotFrames:
    """Looks frames up. Used from the thread that executes goals only."""

    def __init__(self) -> None:
        self._buffer = tf2_ros.Buffer()
        self._listener = tf2_ros.TransformListener(self._buffer)

    def locate(self, frame: str) -> Place:
        """Where a frame is now, seen from above by the robot.

        `frame`: its name. Raises NaoError if it is not connected with the robot.
        """
        robot = tf_prefix() + FOOTPRINT
        patience = rospy.Duration.from_sec(PATIENCE)
        try:
            found = self._buffer.lookup_transform(robot, frame.lstrip("/"), rospy.Time(), patience).transform
        except (tf2_ros.TransformException, tf2_ros.InvalidArgumentException) as error:
            raise NaoError(f"the frame {frame} cannot be found from {robot}: {error}") from error
        return seen_from_above(found)


def seen_from_above(transform: Any) -> Place:
    """Place and heading of a geometry_msgs/Transform on the floor; heading 0 where its rotation is none."""
    move, turn = transform.translation, transform.rotation
    return Place(move.x, move.y, yaw_of_quaternion(turn.x, turn.y, turn.z, turn.w) or 0.0)


def pose_of(position6d: Sequence[float]) -> Pose:
    """A pose from x, y, z in m, roll, pitch, yaw in rad."""
    return Pose(Point(*position6d[:3]), Quaternion(*from_roll_pitch_yaw(*position6d[3:])))


def tf_prefix() -> str:
    """Prefix of the robot's frames, with its slash; empty without the parameter tf_prefix (searched upwards)."""
    found = rospy.search_param("tf_prefix")
    prefix = str(rospy.get_param(found)).strip("/") if found else ""
    return f"{prefix}/" if prefix else ""
