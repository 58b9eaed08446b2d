"""The node naoqi_moveto: walks to goals of RViz and of navigation tools."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Empty

from naoqi.errors import NaoError

from ...base.places import FOOTPRINT, ODOM, Place
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ..base.node import frame_parameter
from ..joints.planar_frames import PlanarFrames, read_place
from .moveto_walk import MoveToWalk, WalkGoal
from .walk_commands import require_way


class NaoqiMoveTo:
    """Walks to poses, in any frame of /tf, with the robot's own planning of steps. A new goal takes over.

    There is no answer: the end is in the log and on /diagnostics. For an answer, use the action `walk_target`.

    ROS API (relative names):
        Subscribes `move_base_simple/goal` (geometry_msgs/PoseStamped), `move_base_simple/cancel` (std_msgs/Empty).
        Parameters `~base_frame_id` (base_footprint), `~odom_frame_id` (odom), `tf_prefix` (searched upwards).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        self._base = frame_parameter(node, "~base_frame_id", FOOTPRINT)
        self._odom = frame_parameter(node, "~odom_frame_id", ODOM)
        self._frames = PlanarFrames(answering_time=robot.connection.answering_time)
        self._walk = MoveToWalk(robot)
        node.if_it_fails(self._walk.close)
        self._node.subscriber("move_base_simple/goal", PoseStamped, self._on_goal, queue_size=1)
        self._node.subscriber("move_base_simple/cancel", Empty, lambda _: self._walk.cancel(), queue_size=1)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"walk": self._walk.report}

    def close(self) -> None:
        self._walk.close()

    def _on_goal(self, goal: PoseStamped) -> None:
        try:
            place, frame = read_place("goal", goal)
        except NaoError as error:
            rospy.logerr("move_base_simple/goal: %s", error)
            return
        name = f"({place.x:.2f} m, {place.y:.2f} m, {place.yaw:.2f} rad) in {frame}"
        self._walk.go(WalkGoal(name, lambda: self._way(goal)))

    def _way(self, goal: PoseStamped) -> Place:
        """The way from where the robot is now; a goal in its own frame is where it was when the goal came."""
        place = self._frames.place_in(self._odom, goal)
        return require_way("goal", place.seen_from(self._frames.locate(self._base, self._odom)))
