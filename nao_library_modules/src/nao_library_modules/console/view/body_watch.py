"""Connection and body of a robot, as its driver reports them, while a page shows them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from .background import Subscriptions
from .body_status import BodyStatus, read_status


class BodyWatch:
    """Of one robot. Any thread.

    ROS API:
        Subscribes, while somebody wants it, `/diagnostics` (diagnostic_msgs/DiagnosticArray) and the relative name
        `connection` (nao_library_msgs/ConnectionState).

    Attributes:
        status: The body; replaced at each report.
        connection: connecting, connected, lost or closed; empty until it is told.
        address: Of the robot.
        problem: What went wrong last with its connection.
    """

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._lock = threading.Lock()
        self._users = 0
        self._subscriptions = Subscriptions(f"body of {robot.name}")
        self._clear()

    def acquire(self) -> Callable[[], None]:
        """Follow it until what comes back is called, which may be called twice."""
        from diagnostic_msgs.msg import DiagnosticArray

        from nao_library_msgs.msg import ConnectionState

        with self._lock:
            self._users += 1
            if self._users == 1:
                topic = self._robot.topic
                self._subscriptions.begin(
                    partial(topic, "/diagnostics", DiagnosticArray, self._on_diagnostics, queue_size=20),
                    partial(topic, "connection", ConnectionState, self._on_connection),
                )
        given = threading.Lock()  # a lock that is taken once
        return lambda: self._release() if given.acquire(blocking=False) else None

    def _release(self) -> None:
        with self._lock:
            self._users -= 1
            if self._users:
                return
            self._subscriptions.end()
            self._clear()

    def _clear(self) -> None:
        self.status = BodyStatus()
        self.connection = self.address = self.problem = ""

    def _on_diagnostics(self, told: Any) -> None:
        self.status = read_status(told.status, self._robot.namespace, self.status)

    def _on_connection(self, told: Any) -> None:
        self.connection, self.address, self.problem = told.state, told.address, told.last_error
