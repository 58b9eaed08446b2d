"""Where frames of /tf are, seen from the robot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion

from naoqi.errors import NaoError

from ..base.doors import Later
from ..base.places import FOOTPRINT, Place, yaw_of_quaternion
from ..base.rotations import from_roll_pitch_yaw

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
