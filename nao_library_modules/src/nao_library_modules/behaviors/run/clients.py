"""The ROS side of behaviours: clients of the servers, and what is sent to them by anybody."""

from __future__ import annotations

import threading
from functools import partial
from typing import Any

from ..process_modules.action_client import PlanActionClient
from .recording import Recording
from .servers import NAMES, server_of

CLOCKS_APART = 1.0
"""s that the stamp of a goal may lie before its arrival, or after it where simulated time reaches one program later
than the other: what is further away was stamped by another clock."""


class ServerClient(PlanActionClient):
    """Client of a server whose goals are chains of functions; see `PlanActionClient.call` and `wait_for_server`."""

    def __init__(self, name: str) -> None:
        super().__init__(name, server_of(name).action)


class Clients:
    """The clients, each made when it is needed first and then kept."""

    def __init__(self) -> None:
        self._clients: dict[str, ServerClient] = {}
        self._lock = threading.Lock()

    def __call__(self, name: str) -> ServerClient:
        """The client of a server.

        Raises:
            BadGoal: If there is no server of that name.
        """
        with self._lock:
            if name not in self._clients:
                self._clients[name] = ServerClient(name)
            return self._clients[name]


class GoalLog:
    """Listens to what anybody sends to the servers: keeps the last goal of each, and passes on what is recorded.

    ROS API:
        Subscribes to `SERVER/goal` and `SERVER/result` of all servers that behaviours may use.

    Args:
        edge: With `subscribe` and `clock`, see `ros_edge`.
    """

    def __init__(self, edge: Any) -> None:
        self._clock = edge.clock
        self._last: dict[str, Any] = {}
        self._recording: Recording | None = None
        self._lock = threading.Lock()
        for name in NAMES:
            action = server_of(name).action()
            edge.subscribe(f"{name}/goal", type(action.action_goal), partial(self._sent, name))
            edge.subscribe(f"{name}/result", type(action.action_result), self._ended)

    def last(self, server: str) -> Any:
        """The goal that a server got last; None if it got none."""
        with self._lock:
            return self._last.get(server)

    def record(self, recording: Recording | None) -> None:
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
