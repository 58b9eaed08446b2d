"""The XML-RPC API of the ROS master and of nodes, with a limit for each call; what to say when the master is gone."""

from __future__ import annotations

import http.client
import logging
import threading
import xmlrpc.client
from typing import Any

import rosgraph

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
