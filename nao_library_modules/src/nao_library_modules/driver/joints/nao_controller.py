"""The node nao_controller: joints and stiffness, with the names of nao_robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Empty, Trigger, TriggerResponse

from nao_library_actions.msg import (
    JointAnglesWithSpeedAction,
    JointAnglesWithSpeedResult,
    JointTrajectoryAction,
    JointTrajectoryFeedback,
    JointTrajectoryResult,
)
from nao_library_msgs.msg import JointAnglesWithSpeed
from naoqi.errors import NaoError

from ...core.health import Report
from ...core.waiting import CancellationToken
from ...ros.action_server import ConcurrentActionServer, GoalOutcome
from ...ros.node_interface import NodeInterface
from ..base.driver_node import interrupt_when_lost, whenever
from .joint_controller import InitialStiffness, JointController, Reached

COMPLAINT_PERIOD = 5.0
"""s between two complaints about messages of one topic that cannot be carried out."""
SHUTDOWN_LIMIT = 2.0
"""s that the end of the node waits for running goals to be interrupted."""


class NaoController:
    """Joint control of one robot.

    Goals of one action for different joints run side by side; one for joints that an older goal moves ends the older
    one. A cancelled goal ends the motion on the robot at once, and its result has the angles of the joints then.

    ROS API (relative names):
        Subscribes `joint_angles` (nao_library_msgs/JointAnglesWithSpeed), `joint_stiffness` (sensor_msgs/JointState:
        name and effort).
        Publishes `get_life_state` (std_msgs/String, latched): state of autonomous life when a service asked or
        changed it.
        Actions `joint_trajectory` (its feedback has ten times a second the commanded and measured angles and their
        difference), `joint_stiffness_trajectory` (nao_library_actions/JointTrajectory), `joint_angles_action`
        (nao_library_actions/JointAnglesWithSpeed).
        Services `body_stiffness/enable`, `body_stiffness/disable`, `wakeup`, `rest`, `life/enable`, `life/disable`
        (std_srvs/Empty), `life/get_state` (std_srvs/Trigger).
        Parameter `~init_stiffness` (0): stiffness that the body gets when the robot is reached, if above 0.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        self._robot = robot
        self._joints = JointController(robot)
        init_stiffness = InitialStiffness(self._joints, node.param)
        self._servers: dict[str, ConcurrentActionServer] = {}
        self._serve("joint_trajectory", JointTrajectoryAction, self._trajectory_joints, self._trajectory, True)
        self._serve("joint_stiffness_trajectory", JointTrajectoryAction, self._trajectory_joints, self._stiffness)
        self._serve("joint_angles_action", JointAnglesWithSpeedAction, self._angles_joints, self._angles)
        self._life = self._node.publisher("get_life_state", String, queue_size=1, latch=True)
        self._node.offer("body_stiffness/enable", Empty, lambda _: self._joints.set_body_stiffness(1.0))
        self._node.offer("body_stiffness/disable", Empty, lambda _: self._joints.set_body_stiffness(0.0))
        self._node.offer("wakeup", Empty, lambda _: self._joints.wake_up())
        self._node.offer("rest", Empty, lambda _: self._joints.rest())
        self._node.offer("life/enable", Empty, lambda _: self._set_life(True))
        self._node.offer("life/disable", Empty, lambda _: self._set_life(False))
        self._node.service("life/get_state", Trigger, self._on_life_state)
        self._stop_watching = interrupt_when_lost(robot, node, *self._servers.values())
        self._stop_stiffening = whenever(robot, node, "connected", init_stiffness.apply)
        self._node.subscriber("joint_angles", JointAnglesWithSpeed, self._on_angles, queue_size=10)
        self._node.subscriber("joint_stiffness", JointState, self._on_stiffness, queue_size=10)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {f"goals {name}": server.counter.report for name, server in self._servers.items()}

    def close(self) -> None:
        self._stop_stiffening()
        self._stop_watching()
        for server in self._servers.values():
            server.close(SHUTDOWN_LIMIT / len(self._servers))

    # --- actions --------------------------------------------------------------------------------------------------

    def _serve(
        self,
        name: str,
        action: type,
        claims: Callable[[Any], frozenset[str]],
        execute: Callable[..., GoalOutcome],
        with_feedback: bool = False,
    ) -> None:
        self._servers[name] = ConcurrentActionServer(claims, execute, with_feedback, self._robot)
        self._node.action(name, action, self._servers[name])

    def _trajectory_joints(self, goal: Any) -> frozenset[str]:
        return frozenset(self._joints.joints_of(goal.trajectory.joint_names))

    def _angles_joints(self, goal: Any) -> frozenset[str]:
        return frozenset(self._joints.joints_of(goal.joint_angles.joint_names))

    def _trajectory(self, goal: Any, interrupt: CancellationToken, publish: Callable[[Any], None]) -> GoalOutcome:
        began = rospy.Time.now()

        def report(joints: Sequence[str], desired: Sequence[float], actual: Sequence[float]) -> None:
            feedback = JointTrajectoryFeedback(joint_names=list(joints))
            feedback.header.stamp = rospy.Time.now()
            off = [wanted - there for wanted, there in zip(desired, actual)]
            for point, values in ((feedback.desired, desired), (feedback.actual, actual), (feedback.error, off)):
                point.positions, point.time_from_start = list(values), feedback.header.stamp - began
            publish(feedback)

        frames = self._joints.trajectory(goal.trajectory, relative=goal.relative != 0)
        reached = self._joints.follow(frames, interrupt, report)
        return _outcome(JointTrajectoryResult(), goal.trajectory.joint_names, reached)

    def _stiffness(self, goal: Any, interrupt: CancellationToken) -> GoalOutcome:
        frames = self._joints.stiffness_trajectory(goal.trajectory)
        reached = self._joints.stiffen(frames, interrupt)
        return _outcome(JointTrajectoryResult(), goal.trajectory.joint_names, reached)

    def _angles(self, goal: Any, interrupt: CancellationToken) -> GoalOutcome:
        asked = goal.joint_angles
        names, angles = asked.joint_names, asked.joint_angles
        reached = self._joints.move(names, angles, asked.speed, asked.relative != 0, interrupt)
        return _outcome(JointAnglesWithSpeedResult(), names, reached)

    # --- topics and services --------------------------------------------------------------------------------------

    def _on_angles(self, message: JointAnglesWithSpeed) -> None:
        try:
            self._joints.set_angles(message.joint_names, message.joint_angles, message.speed, message.relative != 0)
        except NaoError as error:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f"joint_angles: {error}")

    def _on_stiffness(self, message: JointState) -> None:
        try:
            self._joints.set_stiffnesses(message.name, message.effort)
        except NaoError as error:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f"joint_stiffness: {error}")

    def _set_life(self, alive: bool) -> None:
        self._joints.set_life(alive)
        self._life.publish(self._joints.life_state())

    def _on_life_state(self, _request: Any) -> TriggerResponse:
        try:
            state = self._joints.life_state()
        except NaoError as error:
            return TriggerResponse(False, str(error))
        self._life.publish(state)
        return TriggerResponse(True, state)


def _outcome(result: Any, names: Sequence[str], reached: Reached) -> GoalOutcome:
    result.goal_position.header.stamp = rospy.Time.now()
    result.goal_position.name = list(names)
    result.goal_position.position = reached.values
    return GoalOutcome(result, reached.preempted)
