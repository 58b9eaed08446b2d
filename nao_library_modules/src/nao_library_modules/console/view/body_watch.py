"""Connection and body of a robot, as its driver reports them, while a page shows them."""

from __future__ import annotations

from functools import partial
from typing import Any

from .background import Subscriptions, Takers
from .body_status import BodyStatus, read_status


class BodyWatch:
    """Of one robot. Any thread.

    ROS API:
        Subscribes, while somebody wants it, `/diagnostics` (diagnostic_msgs/DiagnosticArray) and the relative name
        `connection` (nao_library_msgs/ConnectionState).

    Attributes:
        acquire: Follows the body until what it returns is called.
        status: The body; replaced at each report.
        connection: connecting, connected, silent, lost or closed; empty until it is told.
        address: Of the robot.
        problem: What went wrong last with its connection.
    """

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._subscriptions = Subscriptions(f"body of {robot.name}")
        self.acquire = Takers(self._begin, self._end).acquire
        self._clear()

    def _begin(self) -> None:
        from diagnostic_msgs.msg import DiagnosticArray

        from nao_library_msgs.msg import ConnectionState

        topic = self._robot.topic
        self._subscriptions.begin(
            partial(topic, "/diagnostics", DiagnosticArray, self._on_diagnostics, queue_size=20),
            partial(topic, "connection", ConnectionState, self._on_connection),
        )

    def _end(self) -> None:
        self._subscriptions.end()
        self._clear()

    def _clear(self) -> None:
        self.status = BodyStatus()
        self.connection = self.address = self.problem = ""

    def _on_diagnostics(self, told: Any) -> None:
        self.status = read_status(told.status, self._robot.namespace, self.status)

    def _on_connection(self, told: Any) -> None:
        self.connection, self.address, self.problem = told.state, told.address, told.last_error
