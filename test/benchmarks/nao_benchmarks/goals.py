"""Goals for lights and motion, and a client that measures round trips instead of its own waiting."""

from __future__ import annotations

import threading
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutGoal, NaoBehaviorGoal, NaoLedAction, NaoLedGoal, NaoMotionGoal
from nao_library_msgs.msg import AudioOutFunction, BehaviorFunction, LedFunction, MotionFunction

from .errors import BenchmarkError

GOAL_LIMIT = 20.0


def list_group(group: str) -> NaoLedGoal:
    """A goal with one function that needs no call to the robot once the server knows the robot's lights."""
    return NaoLedGoal([LedFunction(function="listGroup", str_param=group)])


def set_intensity(light: str, count: int) -> NaoLedGoal:
    """A goal with a chain of `count` functions; each makes one call to the robot."""
    # Alternating, so that every call changes something.
    return NaoLedGoal(
        [LedFunction(function="setIntensity", lights=[light], i_values=[float(i % 2)]) for i in range(count)]
    )


def set_angles(joint: str, angle: float, speed: float) -> NaoMotionGoal:
    """A goal that gives a joint a target (rad) at a fraction of its top speed, and is over then."""
    return NaoMotionGoal([MotionFunction(function="setAngles", names=[joint], angles=[angle], speed=speed)])


def interpolate(joint: str, angle: float, duration: float) -> NaoMotionGoal:
    """A goal that moves a joint to an angle (rad) in a time (s)."""
    function = MotionFunction(function="angleInterpolation", names=[joint], angles=[angle], times=[duration])
    return NaoMotionGoal([function])


def say(text: str) -> NaoAudioOutGoal:
    """A goal that says a text and is over when that is said."""
    return NaoAudioOutGoal([AudioOutFunction(function="say", str_param=text)])


def run_behavior(name: str) -> NaoBehaviorGoal:
    """A goal that runs a stored behaviour."""
    return NaoBehaviorGoal([BehaviorFunction(function="runBehavior", str_param=name)])


class GoalClient:
    """Sends goals to one server and waits for their ends.

    `SimpleActionClient.wait_for_result` waits in slices of 100 ms, and its done callback comes before it is
    ready for the next goal. The client below it tells of each transition when the message arrives.

    Attributes:
        server: Name of the action.

    Args:
        server: Name of the action.
        limit: Longest wait for the server, in s.
        action: Its type.

    Raises:
        BenchmarkError: If the server does not come up.
    """

    def __init__(self, server: str, limit: float, action: type = NaoLedAction) -> None:
        self.server = server
        self._client = actionlib.ActionClient(server, action)
        if not self._client.wait_for_server(rospy.Duration(limit)):
            raise BenchmarkError(f"no action server {server} within {limit:g} s")

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
