"""A client of action servers that measures round trips instead of its own waiting."""

from __future__ import annotations

import threading
from typing import Any, Mapping

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_modules.core.server_types import server_type

from .errors import BenchmarkError

GOAL_LIMIT = 20.0


class GoalClient:
    """Sends goals to one server and waits for their ends.

    `SimpleActionClient.wait_for_result` waits in slices of 100 ms, and its done callback comes before it is
    ready for the next goal. The client below it tells of each transition when the message arrives.

    Attributes:
        server: Name of the action.

    Args:
        server: Name of the action.
        kind: Name of the server of ours that has the same action.
        limit: Longest wait for the server, in s.

    Raises:
        BenchmarkError: If the server does not come up.
    """

    def __init__(self, server: str, kind: str, limit: float) -> None:
        self.server = server
        self._type = server_type(kind)
        self._client = actionlib.ActionClient(server, self._type.action)
        if not self._client.wait_for_server(rospy.Duration(limit)):
            raise BenchmarkError(f"no action server {server} within {limit:g} s")

    def goal(self, function: str, *fields: Mapping[str, object]) -> Any:
        """A goal that calls a function once with each of some fields."""
        return self._type.goal([self._type.function(function=function, **each) for each in fields])

    def send(self, goal: Any) -> actionlib.ClientGoalHandle:
        """Send a goal and go on; the handle cancels it."""
        return self._client.send_goal(goal)

    def run(self, goal: Any) -> None:
        """Send a goal and wait until it has succeeded.

        Raises:
            BenchmarkError: If it ends in another way, or not in time.
        """
        done = threading.Event()

        def changed(handle: actionlib.ClientGoalHandle) -> None:
            if handle.get_comm_state() == actionlib.CommState.DONE:
                done.set()

        handle = self._client.send_goal(goal, changed)
        if not done.wait(GOAL_LIMIT):
            raise BenchmarkError(f"a goal of {self.server} did not end within {GOAL_LIMIT:g} s")
        status = handle.get_goal_status()
        if status != GoalStatus.SUCCEEDED:
            text = f"{GoalStatus.to_string(status).lower()} {handle.get_goal_status_text()}".rstrip()
            raise BenchmarkError(f"a goal of {self.server} ended {text}")
