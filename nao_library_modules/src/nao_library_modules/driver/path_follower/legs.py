"""The robot's legs as nao_path_follower moves them: through nao_walker's topics and services."""

from __future__ import annotations

import math
import threading
import time
from typing import Any

import rospy
from geometry_msgs.msg import Pose2D, Twist, Vector3
from std_srvs.srv import Empty

from naoqi.errors import NaoError, RobotError
from naoqi.limits import ANSWER_LIMIT, STOP_LIMIT

from ...base.cancellation import CancellationToken
from ...base.places import Place
from ...nao.joint_names import MOTION, MOVE_FAILED
from ...nao.stiff_legs import ask_for_stiff_legs
from ...owners.line import SERVICE
from ...robot.robot_task import run_task
from ...ros.node_interface import NodeInterface
from ..base.lazy_topic import LazyTopic
from ..joints.joint_sensors import MEMORY

LISTENER_LIMIT = 5.0
"""s to wait for somebody who listens to the commands."""
ON_ITS_WAY, LOOK_PERIOD = 1.0, 0.02
"""s of real time that a command may take to reach nao_walker on a busy computer, and between two looks at the robot."""
STOP, INHIBIT, LET_GO = "stop_walk_srv", "inhibit_walk", "uninhibit_walk"


class WalkTopics:
    """Publishes walk commands; asks the robot itself whether it can walk and does. For one thread at a time.

    All methods raise NaoError if the robot cannot be asked or stopped.

    ROS API (relative names):
        Publishes `cmd_pose` (geometry_msgs/Pose2D), `cmd_vel` (geometry_msgs/Twist).
        Calls `stop_walk_srv`, `inhibit_walk`, `uninhibit_walk` (std_srvs/Empty), where they are offered.
    """

    def __init__(self, robot: Any, node: NodeInterface, use_velocities: bool) -> None:
        self._robot = robot
        self._node = node
        self._heard = threading.Event()
        self._topic = "cmd_vel" if use_velocities else "cmd_pose"
        kind = Twist if use_velocities else Pose2D
        self._commands = node.publisher(self._topic, kind, tcp_nodelay=True, queue_size=1)
        LazyTopic(lambda listened: self._heard.set() if listened else None, self._commands)
        self._stop = node.caller(STOP, Empty)
        self._inhibit = node.caller(INHIBIT, Empty)
        self._failed_before: list = []
        self._last_pose = -math.inf  # when it was published, by time.monotonic
        self._let_go = node.caller(LET_GO, Empty)

    def prepare(self, interrupt: CancellationToken) -> None:
        """Get ready to walk: the robot takes the pose for it, if it does not walk already.

        Raises NaoError if it cannot, or nobody passes commands on to it; Preempted, or whatever reason the interrupt
        has.
        """
        if not self._commands.get_num_connections():
            self._heard.wait(LISTENER_LIMIT)
        if not self._commands.get_num_connections():
            raise NaoError(f"nobody listens to {self._node.resolve(self._topic)}: does nao_walker run?")
        self._failed_before = self._last_failure()
        if not self.walking():
            ask_for_stiff_legs(self._robot)
            run_task(self._robot.proxy(MOTION).call_async("moveInit"), interrupt, self._stop_robot)

    def go_to(self, way: Place) -> None:
        """Walk to where a way leads, in the robot's frame; replaces the command before."""
        self._own_walk()
        self._last_pose = time.monotonic()
        self._commands.publish(Pose2D(way.x, way.y, way.yaw))

    def go_at(self, x: float, y: float, yaw: float) -> None:
        """Walk with shares -1..1 of the top speeds."""
        self._own_walk()
        self._commands.publish(Twist(Vector3(x, y, 0.0), Vector3(0.0, 0.0, yaw)))

    def walking(self) -> bool:
        return bool(self._robot.proxy(MOTION).call_async("moveIsActive").result(timeout=ANSWER_LIMIT))

    def why_stopped(self) -> str:
        """Cause of the robot's event MoveFailed since `prepare`, an obstacle for example; empty without one."""
        failure = self._last_failure()
        return str(failure[0]) if failure and failure != self._failed_before else ""

    def stop(self) -> None:
        """Stand, on both feet; returns then."""
        if self._topic == "cmd_vel":
            self._commands.publish(Twist())  # arrives after all velocities before it
        self._stop_now()
        # A pose that arrives after the stop restarts the walk.
        while time.monotonic() - self._last_pose < ON_ITS_WAY:
            if self.walking():
                self._stop_now()
            time.sleep(LOOK_PERIOD)
        self._robot.owners.let_go(self)

    def _stop_now(self) -> None:
        try:
            self._stop()
        except (rospy.ServiceException, rospy.ROSException):  # nobody offers it, or it failed: ask the robot itself
            self._stop_robot()
        standing = self._robot.proxy(MOTION).call_async("waitUntilMoveIsFinished")
        standing.result(timeout=STOP_LIMIT)

    def reserve(self) -> None:
        """Keep others, a joystick for example, from walking."""
        # Held before: a node that is killed in between must not leave it behind.
        self._robot.owners.hold(INHIBIT, "hold on walking", [SERVICE, self._let_go.resolved_name, rospy.get_name()])
        self._call_if_there(self._inhibit)

    def release(self) -> None:
        self._call_if_there(self._let_go)
        self._robot.owners.let_go(INHIBIT)

    def _own_walk(self) -> None:
        """Own the walk of this node: nao_walker, which begins it, goes on when this node dies."""
        self._robot.owners.hold(self, "walk", [MOTION, "stopMove", []])

    def _last_failure(self) -> list:
        """Value of the event: cause, whether the walk had begun, place of an obstacle. Empty before the first one."""
        try:
            value = self._robot.proxy(MEMORY).call_async("getData", MOVE_FAILED).result(timeout=ANSWER_LIMIT)
        except RobotError:
            return []  # nothing has failed yet, or the robot has no such event
        return list(value) if isinstance(value, (list, tuple)) else []

    def _stop_robot(self) -> None:
        self._robot.proxy(MOTION).call_async("stopMove").result(timeout=STOP_LIMIT)

    @staticmethod
    def _call_if_there(service: rospy.ServiceProxy) -> None:
        try:
            service()
        except (rospy.ServiceException, rospy.ROSException) as error:
            rospy.logdebug("%s: %s", service.resolved_name, error)
