"""Goals that other programs send to the servers of a robot, followed by the topics of their actions."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatusArray

from ...cli.output import plain
from ...cli.progress import progress_text
from ...functions.server_types import ACTIONS, server_type
from .runs import ENDS, STATES, Run


class ForeignGoals:
    """Follows the goals of some servers that are not this console's. Any thread.

    `is_own`: whether this console has sent the goal of an id.

    ROS API:
        Subscribes to `SERVER/goal`, `SERVER/status`, `SERVER/feedback`. Publishes `SERVER/cancel`.
    """

    def __init__(self, namespace: str, is_own: Callable[[str], bool]) -> None:
        self._namespace = namespace
        self._is_own = is_own
        self._lock = threading.Lock()
        self._cancels: dict[str, rospy.Publisher] = {}
        self._topics: dict[str, list[Any]] = {}
        self._runs: dict[str, dict[str, Run]] = {}

    def follow(self, servers: Iterable[str]) -> None:
        """Follow these servers of the package, and no others."""
        wanted = {server for server in servers if server in ACTIONS}
        for server in wanted - set(self._topics):
            action = server_type(server).action()
            name = self._namespace + server
            cancels = rospy.Publisher(f"{name}/cancel", GoalID, queue_size=2)
            with self._lock:  # a page may be reading them
                self._cancels[server], self._runs[server] = cancels, {}
            self._topics[server] = [  # whose messages may come before the last of them is made
                rospy.Subscriber(f"{name}/goal", type(action.action_goal), partial(self._sent, server)),
                rospy.Subscriber(f"{name}/status", GoalStatusArray, partial(self._status, server)),
                rospy.Subscriber(f"{name}/feedback", type(action.action_feedback), partial(self._feedback, server)),
            ]
        for server in set(self._topics) - wanted:
            for topic in self._topics.pop(server):
                topic.unregister()
            with self._lock:
                self._runs.pop(server, None)
                publisher = self._cancels.pop(server)
            publisher.unregister()

    def runs(self) -> list[Run]:
        """Those that go on."""
        with self._lock:
            return [run for runs in self._runs.values() for run in runs.values()]

    def _sent(self, server: str, message: Any) -> None:
        names = [function.function for function in message.goal.functions]
        self._known(server, message.goal_id.id, names)

    def _status(self, server: str, message: Any) -> None:
        going = {each.goal_id.id: each for each in message.status_list if each.status not in ENDS}
        for goal, status in going.items():
            run = self._known(server, goal, [])
            if run is not None:
                run.state = STATES.get(status.status, run.state)
        over = {each.goal_id.id: each for each in message.status_list if each.status in ENDS}
        with self._lock:
            ended = [run for goal, run in self._runs.get(server, {}).items() if goal in over]
            for run in ended:
                del self._runs[server][run.id]
        for run in ended:
            run.end(ENDS[over[run.id].status], over[run.id].text)

    def _feedback(self, server: str, message: Any) -> None:
        run = self._known(server, message.status.goal_id.id, [])
        if run is not None:
            run.feedback = plain(message.feedback)
            run.progress = progress_text(run.feedback)

    def _known(self, server: str, goal: str, names: list[str]) -> Run | None:
        """The goal, new or known; None for one of this console."""
        if self._is_own(goal):
            return None
        with self._lock:
            runs = self._runs.get(server)
            if runs is None:
                return None
            if goal not in runs:
                cancel = partial(self._cancels[server].publish, GoalID(id=goal))
                label = ", ".join(names) or "a goal"
                runs[goal] = Run(goal, self._namespace, server, names, label, "", rospy.get_time(), cancel)
            elif names and not runs[goal].functions:
                runs[goal].functions, runs[goal].label = names, ", ".join(names)
            return runs[goal]
