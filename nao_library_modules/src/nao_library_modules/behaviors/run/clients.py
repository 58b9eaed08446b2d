"""The ROS side of behaviours: clients of the servers, and what is sent to them by anybody."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

import rospy

from nao_library_msgs.srv import DescribeFunctions, DescribeFunctionsRequest, DescribeFunctionsResponse

from ...functions.goal_checks import GoalCheck
from ...functions.server_types import DESCRIBE, ServerType, servers_among, those_in
from ...process_modules.robot.action_client import PlanActionClient
from ...ros.check_client import NotAnswered, call_service, check_goals
from ..language.servers import NotDescribed
from .recording import BehaviorRecording

CLOCKS_APART = 1.0
"""s that the stamp of a goal may lie before its arrival, or after it where simulated time reaches one program later
than the other: what is further away was stamped by another clock."""


def describe(server: str, functions: Sequence[str] | None) -> DescribeFunctionsResponse:
    """Have a server that runs describe functions; see `servers.Describe`."""
    request = DescribeFunctionsRequest(
        functions=functions or [], without_arguments=not functions, without_functions=functions is None
    )
    try:
        return call_service(server + DESCRIBE, DescribeFunctions, request)
    except NotAnswered as error:
        raise NotDescribed(str(error)) from None


def running() -> list[str]:
    """Names of the servers that run in this node's namespace; none where there is no master."""
    here = rospy.resolve_name("")
    try:
        _, _, (_, _, services) = rospy.get_master().getSystemState()
    except OSError:
        return []
    return sorted(those_in(here, servers_among(name for name, _ in services)))


class ServerClient(PlanActionClient):
    """Client of a server whose goals are chains of functions; see `PlanActionClient.call` and `wait_for_server`."""

    def check(self, goals: Sequence[Any]) -> GoalCheck:
        """Have the server check goals without carrying them out. Raises NotValidated if it does not, or not in time."""
        return check_goals(self.name, *goals)


class Clients:
    """The clients, each made when it is needed first and then kept.

    `types`: gives the types of a server, or raises BadGoal.
    """

    def __init__(self, types: Callable[[str], ServerType]) -> None:
        self._types = types
        self._clients: dict[str, ServerClient] = {}
        self._lock = threading.Lock()

    def __call__(self, name: str) -> ServerClient:
        """The client of a server. Raises BadGoal if there is no server of that name."""
        with self._lock:
            if name not in self._clients:
                server = self._types(name)
                self._clients[name] = ServerClient(server.name, server.action)
            return self._clients[name]


class GoalLog:
    """Listens to what anybody sends to the servers: keeps the last goal of each, and passes on what is recorded.

    ROS API:
        Subscribes to `SERVER/goal` and `SERVER/result` of all servers that it listens to.

    `node`: with `subscribe` and `clock`, see `server_node`. `servers`: the servers that it listens to from the
    beginning.
    """

    def __init__(self, node: Any, servers: Iterable[ServerType]) -> None:
        self._node = node
        self._clock = node.clock
        self._heard: set[str] = set()
        self._last: dict[str, Any] = {}
        self._recording: BehaviorRecording | None = None
        self._lock = threading.Lock()
        for server in servers:
            self.listen(server)

    def listen(self, server: ServerType) -> None:
        with self._lock:
            if server.name in self._heard:
                return
            self._heard.add(server.name)
        action = server.action()
        self._node.subscribe(f"{server.name}/goal", type(action.action_goal), partial(self._sent, server.name))
        self._node.subscribe(f"{server.name}/result", type(action.action_result), self._ended)

    def last(self, server: str) -> Any:
        """The goal that a server got last; None if it got none."""
        with self._lock:
            return self._last.get(server)

    def record(self, recording: BehaviorRecording | None) -> None:
        """Tell a recording what is sent from now on; None ends that."""
        with self._lock:
            self._recording = recording

    def _sent(self, server: str, message: Any) -> None:
        now = self._clock.now()
        stamp = message.header.stamp.to_sec()
        # The stamp is when the client sent it, the truth if its clock is ours.
        time = stamp if abs(now - stamp) <= CLOCKS_APART else now
        with self._lock:
            self._last[server] = message.goal
            recording = self._recording
        if recording is not None:
            recording.sent(server, message.goal_id.id, message.goal, time)

    def _ended(self, message: Any) -> None:
        with self._lock:
            recording = self._recording
        if recording is not None:
            recording.ended(message.status.goal_id.id, message.status.status, self._clock.now())
