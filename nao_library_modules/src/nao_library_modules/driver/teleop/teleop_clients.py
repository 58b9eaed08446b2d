"""Clients of the driver for teleoperation: topics at once, services and poses in a queue in the background."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Sequence

import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist, Vector3
from std_msgs.msg import String
from std_srvs.srv import Empty

from nao_library_actions.msg import BodyPoseAction, BodyPoseGoal
from nao_library_msgs.msg import JointAnglesWithSpeed

from ...ros.driver_types import spoken
from ...ros.goal_client import SimpleActionClient
from ..walk.walk_commands import Velocity

HEAD = ("HeadYaw", "HeadPitch")
HEAD_SPEED = 0.2
POSE_LIMIT = 10.0
"""s that a pose may take."""


class TeleopClients:
    """Clients of nao_walker, nao_controller and pose_manager.

    Any thread may call; nothing here waits. Failures are reported by `report`.

    ROS API (relative names):
        Publishes `cmd_vel` (geometry_msgs/Twist), `joint_angles` (nao_library_msgs/JointAnglesWithSpeed), `speech`
        (std_msgs/String). Calls `stop_walk_srv`, `body_stiffness/enable`, `body_stiffness/disable`, `wakeup`, `rest`
        (std_srvs/Empty), and the action `body_pose` (nao_library_actions/BodyPose).
    """

    def __init__(self, report: Callable[[str], None]) -> None:
        """Create the clients; the servers need not be there yet.

        `report` gets a line of text when something was done, or could not be.
        """
        self._report = report
        self._cmd_vel = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        self._joint_angles = rospy.Publisher("joint_angles", spoken(JointAnglesWithSpeed), queue_size=1)
        self._speech = rospy.Publisher("speech", String, queue_size=10)
        self._poses = SimpleActionClient("body_pose", spoken(BodyPoseAction))
        self._jobs: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="teleoperation", daemon=True)
        self._thread.start()

    # --- at once --------------------------------------------------------------------------------------------------

    def walk(self, velocity: Velocity) -> None:
        self._cmd_vel.publish(Twist(Vector3(velocity.x, velocity.y, 0.0), Vector3(0.0, 0.0, velocity.theta)))

    def turn_head(self, angles: Sequence[float]) -> None:
        """Turn the head to yaw and pitch, rad."""
        self._joint_angles.publish(
            JointAnglesWithSpeed(joint_names=HEAD, joint_angles=list(angles), speed=HEAD_SPEED, relative=0)
        )

    def say(self, text: str) -> None:
        self._speech.publish(text)

    # --- one after the other --------------------------------------------------------------------------------------

    def call(self, service: str, done: str = "") -> None:
        """Call a service of type std_srvs/Empty; `done` is the text when it has answered."""
        self._jobs.put(lambda: self._call(service, done))

    def take_pose(self, name: str, then: str = "") -> None:
        """Take a pose by name, and then call the service `then`, if any."""
        self._jobs.put(lambda: self._take_pose(name, then))

    def close(self) -> None:
        self._jobs.put(None)

    def _run(self) -> None:
        for job in iter(self._jobs.get, None):
            try:
                job()
            except rospy.ROSException as error:
                self._report(str(error))

    def _call(self, service: str, done: str) -> bool:
        try:
            rospy.ServiceProxy(service, Empty)()
        except rospy.ServiceException as error:
            self._report(f"{service}: {error}")
            return False
        if done:
            self._report(done)
        return True

    def _take_pose(self, name: str, then: str) -> None:
        limit = rospy.Duration.from_sec(POSE_LIMIT)
        if not self._poses.wait_for_server(limit):
            self._report("server of body_pose not found: is pose_manager running?")
            return
        state = self._poses.send_goal_and_wait(BodyPoseGoal(name), limit)
        text = f"{name}: {GoalStatus.to_string(state).lower()} {self._poses.get_goal_status_text()}"
        self._report(text.rstrip())
        if state == GoalStatus.SUCCEEDED and then:
            self._call(then, "")
