"""The XML-RPC API of the ROS master and of nodes, and nodes that are parts of one process."""

from __future__ import annotations

import http.client
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

log = logging.getLogger(__name__)

LIMIT = 2.0
"""s that an answer may take."""
CHECK_PERIOD = 1.0
"""s between two looks at the master."""
GONE = (OSError, http.client.HTTPException, xmlrpc.client.Error)
"""What a call of a master or node raises that does not answer."""


class Refused(Exception):  # an answer of the master
    """The master, or a node, answers that something is not so."""


class _Transport(xmlrpc.client.Transport):
    """Calls that end: a process that is stopped accepts them and never answers."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        """As the library's, with a limit."""
        connection = super().make_connection(host)
        connection.timeout = LIMIT
        return connection


class Api:
    """A master or node over XML-RPC."""

    def __init__(self, uri: str, caller: str) -> None:
        self._proxy = xmlrpc.client.ServerProxy(uri, transport=_Transport(), allow_none=True)
        self._caller = caller

    def ask(self, method: str, *arguments: Any) -> Any:
        """Call a method and return its value.

        Raises Refused: the answer is that it is not so; OSError: and others of `GONE`: there is no answer.
        """
        code, text, value = getattr(self._proxy, method)(self._caller, *arguments)
        if code != 1:
            raise Refused(text)
        return value


def node_runs(name: str, but: str = "") -> bool:
    """Whether a node of that full name runs, other than the one at the address `but`; false if the master is gone."""
    try:
        uri = Api(rosgraph.get_master_uri(), name).ask("lookupNode", name)
    except (Refused, *GONE):
        return False
    if uri == but:
        return False
    try:
        Api(uri, name).ask("getPid")
    except ConnectionRefusedError:  # it died without a word
        return False
    except (Refused, *GONE):
        pass
    return True


class MasterCheck:
    """Says in the log that the ROS master is gone or was started again, and what to do. A thread of its own.

    Nodes go on with the connections that they have, but nobody new finds them: as everywhere in ROS, what was launched
    has to be started again.

    Attributes:
        uri: Of the master.
        caller: Name of this node.
    """

    def __init__(self, uri: str, caller: str) -> None:
        self.uri = uri
        self.caller = caller
        self._pid: int | None = None
        self._gone = False
        self._ended = threading.Event()
        threading.Thread(target=self._run, name="check of the master", daemon=True).start()

    def close(self) -> None:
        self._ended.set()

    def _run(self) -> None:
        while not self._ended.wait(CHECK_PERIOD):
            self.look()

    def look(self) -> None:
        """Ask the master once, and log what has changed."""
        try:
            pid = Api(self.uri, self.caller).ask("getPid")
        except (Refused, *GONE) as error:
            if not self._gone:
                log.warning(
                    "the ROS master at %s does not answer (%s): what is under way goes on, but no program finds these "
                    "nodes. If it has ended, end this launch and start it again",
                    self.uri,
                    error or repr(error),
                )
            self._gone = True
            return
        if self._pid is not None and pid != self._pid:
            log.error(
                "the ROS master at %s was started again and knows none of these nodes: end this launch and start it "
                "again",
                self.uri,
            )
        elif self._gone:
            log.info("the ROS master at %s answers again", self.uri)
        self._pid, self._gone = pid, False


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
