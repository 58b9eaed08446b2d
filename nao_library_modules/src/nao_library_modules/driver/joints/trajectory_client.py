"""Sends a pose to the action joint_trajectory and waits for it, in a way that can be interrupted."""

from __future__ import annotations

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions.msg import JointTrajectoryAction, JointTrajectoryGoal
from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...nao.pose_tables import Pose
from ...ros.goal_tracker import GoalTracker
from ...ros.ros_clock import RosClock

ACTION = "joint_trajectory"
SERVER_LIMIT = 5.0
"""s to wait for the server of the action."""
MARGIN = 1.0
"""s that a pose may take longer than it says."""
CANCEL_LIMIT = 2.0
"""s that a cancelled pose may take to end."""


class TrajectoryClient:
    """Client of `joint_trajectory`. Any thread may take a pose.

    It stands on actionlib's ActionClient: SimpleActionClient knows one goal at a time, and looks for its end every
    tenth of a second.
    """

    def __init__(self) -> None:
        self._client = actionlib.ActionClient(ACTION, JointTrajectoryAction)
        self._clock = RosClock()

    def take(self, pose: Pose, interrupt: CancellationToken) -> None:
        """Take a pose, unless the interrupt ends it.

        Raises:
            NaoError: If there is no server, or it does not get there in time.
            Preempted: Or whatever reason the interrupt has.
        """
        if not self._client.wait_for_server(rospy.Duration(SERVER_LIMIT)):
            raise NaoError(f"there is no server for {rospy.resolve_name(ACTION)}: is nao_controller running?")
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
