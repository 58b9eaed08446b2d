"""Behaviours that are run by the server NaoBehavior, for touches."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorGoal
from nao_library_msgs.msg import BehaviorFunction
from naoqi.errors import NaoError

from .goal_client import ACKNOWLEDGEMENT_LIMIT, SERVER_LIMIT, GoalTracker

SERVER = "NaoBehavior"


class BehaviorClient:
    """Client of NaoBehavior. Nothing of ROS is needed before the first behaviour is to run.

    It stands on actionlib's ActionClient: a behaviour that was started by another touch goes on being followed when the
    next one replaces it.
    """

    def __init__(self) -> None:
        self._client: actionlib.ActionClient | None = None
        self._lock = threading.Lock()
        self._goals: dict[GoalTracker, Any] = {}  # with the handle of each

    def run(self, behavior: str, parameters: Sequence[str], done: Callable[[str, str], None]) -> None:
        """Start a behaviour and go on.

        Raises NaoError if there is no server.

        Args:
            behavior: Its name.
            parameters: Each as name=value.
            done: Gets how it ended and what was said about it, once, in a thread of actionlib.
        """
        with self._lock:
            if self._client is None:
                self._client = actionlib.ActionClient(SERVER, NaoBehaviorAction)
            client = self._client
        if not client.wait_for_server(rospy.Duration(SERVER_LIMIT)):
            raise NaoError(f"there is no server {rospy.resolve_name(SERVER)}: nobody can run {behavior}")
        function = BehaviorFunction(function="runBehavior", str_param=behavior, parameters=list(parameters))
        watch = GoalTracker()

        def changed(handle: Any) -> None:
            was_over = watch.over.is_set()
            watch.look(handle)
            if was_over or not watch.over.is_set():
                return
            with self._lock:
                self._goals.pop(watch, None)
            done(GoalStatus.to_string(handle.get_terminal_state()).lower(), handle.get_goal_status_text())

        handle = client.send_goal(NaoBehaviorGoal([function]), changed)
        with self._lock:
            if not watch.over.is_set():
                # actionlib forgets a goal whose handle nobody holds.
                self._goals[watch] = handle

    def close(self) -> None:
        """Cancel the behaviours that run."""
        with self._lock:
            goals, self._goals = self._goals, {}
        end = time.monotonic() + ACKNOWLEDGEMENT_LIMIT
        for watch, handle in goals.items():
            watch.cancel(handle, max(end - time.monotonic(), 0.0))
