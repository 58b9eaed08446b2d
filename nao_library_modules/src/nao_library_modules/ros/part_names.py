"""Nodes of nao_robot that are parts of one process here: `rosnode` and `rosservice` find them by their names."""

from __future__ import annotations

import logging
import os
import threading
import xmlrpc.client
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import rosgraph
import rospy
from rosgraph.xmlrpc import XmlRpcHandler, XmlRpcNode
from std_srvs.srv import Trigger, TriggerResponse

from .master_api import GONE, node_runs

log = logging.getLogger(__name__)

PART_OF = "/part_of_"
"""Stands in the name of a service between the full name of a part and the name of its node, without its namespace."""
START_LIMIT = 10.0
"""s until the names have an address."""


def parts_among(services: Iterable[str]) -> dict[str, str]:
    """Full name of a part -> name of its node, of those that these services tell of; full names of services."""
    found = (name.partition(PART_OF) for name in services)
    return {part: node for part, middle, node in found if middle}


class PartNames:
    """Registers names of parts at the ROS master, with an address of their own that leads to this process.

    The master shuts down whoever has a name that another node takes. With the address of the process it would shut all
    parts down; this one only notes it. Topics are not registered a second time: subscribers would connect twice.

    ROS API:
        Services `PART/part_of_NODE` (std_srvs/Trigger): the topics, services and actions of a part.
    """

    def __init__(self) -> None:
        self._answers = _Answers()
        self._node = XmlRpcNode(rpc_handler=self._answers)
        self._node.start()
        self._services: dict[str, str] = {}  # its service -> full name of a part

    def add(self, name: str, offered: Mapping[str, Sequence[str]]) -> None:
        """Register a part, unless a node of its name is there. `offered`: kind of what it has in ROS -> full names."""
        node = rospy.get_name()
        service = f"{name}{PART_OF}{node.rpartition('/')[2]}"
        try:
            if node_runs(name) or not self._answers.ready.wait(START_LIMIT):
                return
            rospy.Service(service, Trigger, lambda _: TriggerResponse(True, _listed(name, node, offered)))
            master = rosgraph.Master(name)
            master.registerService(service, master.lookupService(service), self._node.uri)
        except (*GONE, rosgraph.MasterException) as error:
            log.warning("rosnode does not find %s, which is a part of %s: %s", name, node, error)
            return
        self._services[service] = name

    def close(self) -> None:
        """Take the names back."""
        for service, name in self._services.items():
            master = rosgraph.Master(name)
            try:
                master.unregisterService(service, master.lookupService(service))
            except (*GONE, rosgraph.MasterException):
                continue  # it does not know the name any more, or has ended


class _Answers(XmlRpcHandler):
    """What a node is asked by ROS's tools. Called from threads of the server; the names are those of the protocol."""

    def __init__(self) -> None:
        self.ready = threading.Event()

    def _ready(self, uri: str) -> None:
        self.ready.set()

    def getPid(self, caller: str) -> tuple[int, str, int]:  # noqa: N802
        return 1, "", os.getpid()

    def getMasterUri(self, caller: str) -> tuple[int, str, str]:  # noqa: N802
        return 1, "", rosgraph.get_master_uri()

    def getBusInfo(self, caller: str) -> tuple[Any, ...]:  # noqa: N802
        """The connections of the process."""
        return tuple(xmlrpc.client.ServerProxy(rospy.get_node_uri()).getBusInfo(caller))

    def shutdown(self, caller: str, reason: str = "") -> tuple[int, str, int]:
        node = rospy.get_name()
        text = f"a part of {node} does not end alone: rosnode kill {node}, or start it without that part (~parts)"
        log.warning("%s, asked by %s: %s", text, caller, reason)
        return 0, text, 0


def _listed(name: str, node: str, offered: Mapping[str, Sequence[str]]) -> str:
    kinds = (f"{kind}: {', '.join(sorted(set(names)))}" for kind, names in offered.items() if names)
    return "; ".join((f"{name} is a part of the node {node}", *kinds))
