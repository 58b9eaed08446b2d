"""What the ROS master knows of servers, services and actions: asked at most once in a while for all robots."""

from __future__ import annotations

import threading
import time
from typing import Any

import rospy

from ...functions.server_types import servers_among, those_in
from ...ros.master_api import GONE

FRESH, PATIENCE = 1.0, 0.5
"""s of this computer: for which an answer is good, and for which one is waited."""
FIRST_PATIENCE = 10.0
"""s for which the first answer is waited: without any, each robot would be told to be none."""
CANCEL, CANCEL_TYPE = "/cancel", "actionlib_msgs/GoalID"
"""End of the names of topics by which goals are cancelled, and their type."""


class MasterLook:
    """The books of the master, as they were a second ago at most. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._read = float("-inf")
        self._services: list[str] = []
        self._subscribed: dict[str, list[str]] = {}
        self._types: dict[str, str] = {}
        self._asking, self._answered = False, threading.Event()

    def namespaces(self) -> list[str]:
        """Of the robots that have servers, each with a slash at both ends, sorted."""
        return sorted({name.rpartition("/")[0] + "/" for name in self._all_servers()})

    def servers(self, namespace: str) -> list[str]:
        """Relative names of the servers of a robot, sorted."""
        return sorted(those_in(namespace, self._all_servers()), key=str.lower)

    def cancel_topics(self, namespace: str) -> list[str]:
        """Full names of the topics by which goals of a robot's actions are cancelled, also those of its driver."""
        self._look()
        return [
            name
            for name in self._subscribed
            if name.startswith(namespace) and name.endswith(CANCEL) and self._types.get(name) == CANCEL_TYPE
        ]

    def services(self) -> list[str]:
        """Full names of all services."""
        self._look()
        return list(self._services)

    def service_address(self, service: str) -> str:
        """Where a service is at this moment, by its full name; empty if it is not there."""
        try:
            code, _, address = rospy.get_master().lookupService(service)
        except GONE:
            return ""
        return address if code == 1 else ""

    def _all_servers(self) -> list[str]:
        self._look()
        return [name for name in servers_among(self._services) if f"{name}/goal" in self._subscribed]

    def _look(self) -> None:
        """Read the registrations again where they are old.

        Wait once for a slow master, and only briefly after its first answer.
        """
        with self._lock:
            if time.monotonic() - self._read < FRESH:
                return
            if self._read == float("-inf"):
                patience = FIRST_PATIENCE
            else:
                patience = 0.0 if self._asking else PATIENCE
            if not self._asking:
                self._asking = True
                self._answered.clear()
                threading.Thread(target=self._ask, name="look at the master", daemon=True).start()
        self._answered.wait(patience)

    def _ask(self) -> None:
        services: Any = []
        subscribers: Any = []
        types: dict[str, str] = {}
        try:
            code, _, state = rospy.get_master().getSystemState()
            if code == 1:
                _, subscribers, services = state
                types = dict(rospy.get_master().getTopicTypes()[2])
        except GONE:
            pass  # no master: nothing runs
        with self._lock:
            self._services = [name for name, _ in services]
            self._subscribed = {name: list(nodes) for name, nodes in subscribers}
            self._types = types
            self._read = time.monotonic()
            self._asking = False
        self._answered.set()
