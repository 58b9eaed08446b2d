"""Clients that send random goals, one a server, each in a thread of its own, and what they have seen."""

from __future__ import annotations

import random
import threading
import time
from collections import Counter
from collections.abc import Callable
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_modules.core.server_types import server_type
from nao_library_modules.ros.goal_client import GoalTracker

from .random_goals import RandomGoals

PATIENCE = 20.0
"""s after which a goal that goes on is cancelled."""
END_LIMIT = 20.0
"""s that a server may take to end a goal that was cancelled. The network may be down for a while of it."""
NAMES = {
    GoalStatus.SUCCEEDED: "succeeded",
    GoalStatus.ABORTED: "aborted",
    GoalStatus.PREEMPTED: "preempted",
    GoalStatus.RECALLED: "preempted",
    GoalStatus.REJECTED: "rejected",
    GoalStatus.LOST: "lost",
}


class Client:
    """Sends goals to one server until it is stopped.

    Attributes:
        server: Name of the server.
        ends: How goals ended: end -> how often.
        unexplained: Goals that were aborted without a text.
        slowest: Longest time from a cancel to the end of its goal, s.
        hung: Goals that did not end.
        lost: Goals that the server did not know any more before their result came.

    Args:
        server: Name of the server.
        seed: Where chance comes from.
        strange: Share of the fields with strange values.
    """

    def __init__(self, server: str, seed: int, strange: float) -> None:
        self.server = server
        self.ends: Counter[str] = Counter()
        self.unexplained = 0
        self.slowest = 0.0
        self.hung: list[str] = []
        self.lost: list[str] = []
        self._goals = RandomGoals(server, seed, strange)
        self._random = random.Random(f"patience {server} {seed}")
        self._client = actionlib.ActionClient(server, server_type(server).action)
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"client of {server}", daemon=True)

    def wait_for_server(self, seconds: float) -> bool:
        """Whether the server is there within `seconds`."""
        return self._client.wait_for_server(rospy.Duration.from_sec(seconds))

    def start(self) -> None:
        """Begin to send goals."""
        self._thread.start()

    def stop(self) -> None:
        """Send no more goals, and wait for the end of the last one."""
        self._stopping.set()
        self._thread.join(PATIENCE + 2.0 * END_LIMIT)

    def sensible_end(self, limit: float) -> tuple[str, str]:
        """Send a goal that makes sense and wait for it: how it ended, and the text of the server."""
        handle, watch = self._send(self._goals.sensible())
        if not watch.over.wait(limit) and watch.cancel(handle, END_LIMIT):
            return "hung", f"no end within {limit:g} s"
        return NAMES.get(handle.get_terminal_state(), "?"), handle.get_goal_status_text()

    def _send(self, goal: Any) -> tuple[Any, GoalTracker]:
        watch = GoalTracker()
        return self._client.send_goal(goal, watch.look), watch

    def _run(self) -> None:
        while not self._stopping.is_set():
            self._one(self._goals.next())

    def _one(self, goal: Any) -> None:
        handle, watch = self._send(goal)
        patience = self._random.uniform(0.0, 1.5) if self._random.random() < 0.3 else PATIENCE
        if not watch.over.wait(patience):
            watch.acknowledged.wait(END_LIMIT)
            began = time.monotonic()
            watch.cancel(handle, 0.0)
            if not watch.over.wait(END_LIMIT):
                self.hung.append(_shown(goal))
                return
            self.slowest = max(self.slowest, time.monotonic() - began)
        end = NAMES.get(handle.get_terminal_state(), "?")
        self.ends[end] += 1
        if end == "lost":
            self.lost.append(_shown(goal))
        if end in ("aborted", "rejected") and not handle.get_goal_status_text():
            self.unexplained += 1


def until(condition: Callable[[], bool], limit: float) -> bool:
    """Whether a condition came true within `limit` s."""
    deadline = time.monotonic() + limit
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.1)
    return True


def _shown(goal: Any) -> str:
    functions = [message.function[:40] for message in goal.functions[:5]]
    return f"{len(goal.functions)} functions: {', '.join(functions)}"
