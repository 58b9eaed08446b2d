"""Stops of other programs: of `nao stop`, and of consoles beside this program."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID


def hear_stops(robot: Any) -> Callable[[], None]:
    """Have the stops of other programs among the events of a robot, as its own; what comes back ends that.

    Who stops everything cancels all goals of each action of the robot, which are known by their topics. This program
    has such a topic of its own: on one of an action it could take the place of the server, which must not miss it.

    `robot`: a `RobotClient`.

    ROS API:
        Subscribes to `NODE/cancel` in the robot's namespace, with the name of this node.
    """

    def take(message: Any) -> None:
        sender = message._connection_header.get("callerid", "")
        if not message.id and message.stamp.is_zero() and sender != rospy.get_name():
            robot.was_stopped(sender)

    return robot.topic(f"{rospy.get_name().strip('/').replace('/', '_')}/cancel", GoalID, take, queue_size=10)
