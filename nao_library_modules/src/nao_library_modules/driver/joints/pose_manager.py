"""The node pose_manager: poses by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from std_srvs.srv import Empty
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import (
    BodyPoseAction,
    BodyPoseGoal,
    BodyPoseResult,
    BodyPoseWithSpeedAction,
    BodyPoseWithSpeedGoal,
    BodyPoseWithSpeedResult,
    JointTrajectoryAction,
    JointTrajectoryGoal,
)
from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ...core.errors import CodedError, ErrorCode
from ...core.fields import require_within
from ...core.health import Report
from ...core.nao_facts import MOTION
from ...core.poses import Pose, UnknownPose, built_in, library, pose_table
from ...core.robot import run_task
from ...core.waiting import CancellationToken
from ...ros.action_server import ConcurrentActionServer, GoalOutcome
from ...ros.driver_types import spoken
from ...ros.goal_client import SERVER_LIMIT, GoalTracker
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock
from ..base.driver_node import interrupt_when_lost
from .joint_controller import FRACTION, STIFFEN_TIME

POSTURE = "ALRobotPosture"
STOP_WALK = "stop_walk_srv"
BODY = frozenset({"Body"})
SHUTDOWN_LIMIT = 2.0
ACTION = "joint_trajectory"
MARGIN = 1.0
"""s that a pose may take longer than it says."""
CANCEL_LIMIT = 2.0
"""s that a cancelled pose may take to end."""


class PostureMissed(CodedError):
    """The robot ended its motion, and not in the posture."""

    code = ErrorCode.POSTURE_MISSED

    def __init__(self, posture: str) -> None:
        super().__init__(f"the robot did not reach the posture {posture}")


class PoseManager:
    """Takes poses that have a name. One at a time: a new goal ends the one before.

    ROS API (relative names):
        Actions `body_pose` (nao_library_actions/BodyPose: a pose of the tables below), `body_pose_naoqi`
        (nao_library_actions/BodyPoseWithSpeed: a posture that the robot knows; the motors are switched on first).
        Calls the action `joint_trajectory`, and the service `stop_walk_srv` (std_srvs/Empty) if there is one.
        Parameters `~poses`: name -> joint_names, positions, time_from_start; read again when a goal names an unknown
        pose. `~xap`: path, or list of paths, of pose libraries of Choregraphe.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        self._robot = robot
        self._poses = self._read_poses()
        self._trajectory = TrajectoryClient()
        self._stop_walk = self._node.caller(STOP_WALK, Empty)
        self._servers = {
            "body_pose": ConcurrentActionServer(lambda _: BODY, self._take_pose, robot=robot),
            "body_pose_naoqi": ConcurrentActionServer(lambda _: BODY, self._take_posture, robot=robot),
        }
        for (name, server), action in zip(self._servers.items(), (BodyPoseAction, BodyPoseWithSpeedAction)):
            self._node.action(name, action, server)
        # Goals of the other action are ended by nao_controller.
        self._stop_watching = interrupt_when_lost(robot, node, self._servers["body_pose_naoqi"])

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {f"goals {name}": server.counter.report for name, server in self._servers.items()}

    def close(self) -> None:
        self._stop_watching()
        for server in self._servers.values():
            server.close(SHUTDOWN_LIMIT / len(self._servers))

    # --- poses of the tables --------------------------------------------------------------------------------------

    def _take_pose(self, goal: BodyPoseGoal, interrupt: CancellationToken) -> GoalOutcome:
        pose = self._pose(goal.pose_name)
        self._end_walk()
        self._trajectory.take(pose, interrupt)
        return GoalOutcome(BodyPoseResult())

    def _pose(self, name: str) -> Pose:
        if name not in self._poses:
            self._poses = self._read_poses()  # more may have been loaded meanwhile
        if name not in self._poses:
            raise UnknownPose(name, self._poses)
        return self._poses[name]

    def _read_poses(self) -> dict[str, Pose]:
        """All poses; a table that cannot be read is logged and left out."""
        poses = built_in()
        paths = self._node.param("~xap", [])
        for path in [paths] if isinstance(paths, str) else list(paths):
            if path:
                _add(poses, lambda path=path: library(path))
        _add(poses, lambda: pose_table(self._node.param("~poses", {})))
        return poses

    def _end_walk(self) -> None:
        try:
            self._stop_walk()
        except rospy.ServiceException as error:
            rospy.logdebug("%s: %s", STOP_WALK, error)  # without the service the robot is not walking

    # --- postures of the robot ------------------------------------------------------------------------------------

    def _take_posture(self, goal: BodyPoseWithSpeedGoal, interrupt: CancellationToken) -> GoalOutcome:
        require_within("speed", goal.speed, FRACTION)
        posture = self._robot.proxy(POSTURE)
        known = posture.call_async("getPostureList").result(timeout=ANSWER_LIMIT)
        if goal.posture_name not in known:
            raise UnknownPose(goal.posture_name, known, "posture")
        motion = self._robot.proxy(MOTION)
        run_task(motion.call_async("stiffnessInterpolation", "Body", 1.0, STIFFEN_TIME), interrupt, lambda: None)

        def stop() -> None:
            posture.call_async("stopMove").result(timeout=ANSWER_LIMIT)

        if not run_task(posture.call_async("goToPosture", goal.posture_name, goal.speed), interrupt, stop):
            raise PostureMissed(goal.posture_name)
        return GoalOutcome(BodyPoseWithSpeedResult())


def _add(poses: dict[str, Pose], read: Callable[[], dict[str, Pose]]) -> None:
    try:
        poses.update(read())
    except NaoError as error:
        rospy.logerr("%s", error)


class TrajectoryClient:
    """Client of `joint_trajectory`. Any thread may take a pose.

    It stands on actionlib's ActionClient: SimpleActionClient knows one goal at a time, and looks for its end every
    tenth of a second.
    """

    def __init__(self) -> None:
        self._client = actionlib.ActionClient(ACTION, spoken(JointTrajectoryAction))
        self._clock = RosClock()

    def take(self, pose: Pose, interrupt: CancellationToken) -> None:
        """Take a pose, unless the interrupt ends it.

        Raises NaoError if the server is not found, or the robot does not get there in time; Preempted, or whatever
        reason the interrupt has.
        """
        if not self._client.wait_for_server(rospy.Duration(SERVER_LIMIT)):
            raise NaoError(f"server of {rospy.resolve_name(ACTION)} not found: is nao_controller running?")
        wake = CancellationToken()
        goal = GoalTracker(wake.trigger)
        handle = self._client.send_goal(_goal(pose), goal.look)
        with interrupt.waking(wake.trigger):
            # The motion has a margin in its own time, and messages have one in real time: simulated time may be faster.
            in_time = not self._clock.wait(pose.time + MARGIN, wake) or wake.wait(MARGIN)
        if not goal.over.is_set():
            goal.cancel(handle)
            goal.over.wait(CANCEL_LIMIT)  # what comes next finds the joints free
            interrupt.check()
        if not in_time:
            raise NaoError(f"not there after {pose.time + MARGIN:g} s, {MARGIN:g} s longer than it should take")
        state = handle.get_terminal_state()
        if state != GoalStatus.SUCCEEDED:
            raise NaoError(handle.get_goal_status_text() or f"{ACTION} ended {GoalStatus.to_string(state)}")


def _goal(pose: Pose) -> JointTrajectoryGoal:
    point = JointTrajectoryPoint(positions=pose.positions, time_from_start=rospy.Duration(pose.time))
    return JointTrajectoryGoal(trajectory=JointTrajectory(joint_names=list(pose.joints), points=[point]))
