"""A ROS master that was started anew knows nobody: what it knew before is told to it again.

Nodes do not notice that their master has gone; they go on with the connections they have, and nobody new finds them.
One node that watches the master is enough, for a node can be registered by another.
"""

from __future__ import annotations

import http.client
import logging
import socket
import threading
import xmlrpc.client
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Dict, Tuple

log = logging.getLogger(__name__)

PERIOD = 1.0
"""s between two looks at the master."""
LOOKS = 10
"""From one reading of all that it knows to the next; of what has come since then nobody knows when the master dies."""
LIMIT = 2.0
"""s that an answer may take."""
ANY_TYPE = "*"
GONE = (OSError, http.client.HTTPException, xmlrpc.client.Error)
"""What a call of a master or node raises that does not answer."""

Registrations = Dict[str, Tuple[str, ...]]


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
    """A master or node over XML-RPC: answers are what it says, or errors."""

    def __init__(self, uri: str, caller: str) -> None:
        self._proxy = xmlrpc.client.ServerProxy(uri, transport=_Transport(), allow_none=True)
        self._caller = caller

    def ask(self, method: str, *arguments: Any, caller: str = "") -> Any:
        """Call a method.

        Raises Refused: the answer is that it is not so; OSError: and others of `GONE`: there is no answer.
        """
        code, text, value = getattr(self._proxy, method)(caller or self._caller, *arguments)
        if code != 1:
            raise Refused(text)
        return value


@dataclass
class Book:
    """What a master knows.

    Attributes:
        pid: Of its process.
        publishers, subscribers, services: Topic or service -> names of nodes.
        types: Topic -> type.
        nodes: Name of a node -> address of its API.
        addresses: Service -> its address.
        parameters: The tree of parameters.
    """

    pid: int
    publishers: Registrations = field(default_factory=dict)
    subscribers: Registrations = field(default_factory=dict)
    services: Registrations = field(default_factory=dict)
    types: dict[str, str] = field(default_factory=dict)
    nodes: dict[str, str] = field(default_factory=dict)
    addresses: dict[str, str] = field(default_factory=dict)
    parameters: dict[str, Any] = field(default_factory=dict)


def read_book(master: Api) -> Book:
    """What a master knows now. A node that begins or ends meanwhile may be left out."""
    book = Book(master.ask("getPid"))
    state = master.ask("getSystemState")
    book.publishers, book.subscribers, book.services = ({name: tuple(who) for name, who in part} for part in state)
    book.types = dict(master.ask("getTopicTypes"))
    for name in sorted({node for part in state for _, who in part for node in who}):
        with suppress(Refused):
            book.nodes[name] = master.ask("lookupNode", name)
    for service in book.services:
        with suppress(Refused):
            book.addresses[service] = master.ask("lookupService", service)
    book.parameters = master.ask("getParam", "/")
    return book


def leaves(tree: dict[str, Any], above: str = "/") -> Iterator[tuple[str, Any]]:
    """Full names of the parameters of a tree, and their values."""
    for name, value in tree.items():
        if isinstance(value, dict) and value:
            yield from leaves(value, f"{above}{name}/")
        else:
            yield above + name, value


def restore(book: Book, master: Api, caller: str) -> int:
    """Tell a master what another knew, as far as it is still so.

    What the new one knows already counts: parameters that have been set, nodes that have been started again. Returns
    how many nodes there are of those that the other knew.
    """
    known = set(master.ask("getParamNames"))
    for name, value in leaves(book.parameters):
        if name not in known:
            master.ask("setParam", name, value)
    nodes = {name: uri for name, uri in book.nodes.items() if _is_there(name, uri, master, caller)}

    def each(registrations: Registrations) -> Iterator[tuple[str, str, str]]:
        return ((name, node, nodes[node]) for name, who in registrations.items() for node in who if node in nodes)

    for service, node, uri in each(book.services):
        if service in book.addresses:
            master.ask("registerService", service, book.addresses[service], uri, caller=node)
    # Publishers first: who listens is told of all of them at once, and drops none meanwhile.
    for topic, node, uri in each(book.publishers):
        master.ask("registerPublisher", topic, book.types.get(topic, ANY_TYPE), uri, caller=node)
    untold: dict[str, tuple[Exception, list[str]]] = {}
    for topic, node, uri in each(book.subscribers):
        kind = book.types.get(topic, ANY_TYPE)
        found = master.ask("registerSubscriber", topic, kind, uri, caller=node)
        try:
            Api(uri, "/master").ask("publisherUpdate", topic, found)
        except (*GONE, Refused) as error:
            untold.setdefault(node, (error, []))[1].append(topic)
    for node, (error, topics) in untold.items():
        log.warning("%s is not told who publishes %s: %r", node, ", ".join(topics), error)
    return len(nodes)


def _is_there(name: str, uri: str, master: Api, caller: str) -> bool:
    """Whether a node lives, and the new master knows no other one of its name."""
    try:
        if master.ask("lookupNode", name) != uri:
            return False
    except Refused:
        pass
    try:
        Api(uri, caller).ask("getPid")
    except socket.timeout:
        return True  # it has no time just now, or was stopped; of one that has ended the address is refused
    except (*GONE, Refused):
        return False
    return True


class MasterWatch:
    """Looks at the master, in a thread of its own, and notices that it is another one.

    `uri`: of the master. `caller`: name of this node.
    """

    def __init__(self, uri: str, caller: str) -> None:
        self._uri = uri
        self._caller = caller
        self._looks = 0
        self._ended = threading.Event()
        threading.Thread(target=self._run, name="watch of the master", daemon=True).start()

    def close(self) -> None:
        self._ended.set()

    def _run(self) -> None:
        book, gone = None, False
        while not self._ended.wait(PERIOD):
            try:
                book, gone = self._look(book), False
            except (*GONE, Refused) as error:
                if not gone:
                    log.warning("the ROS master at %s does not answer: %r", self._uri, error)
                gone = True
            except Exception:  # a mistake in here must not end the watch
                log.exception("the ROS master cannot be watched")

    def _look(self, book: Book | None) -> Book:
        master = Api(self._uri, self._caller)
        self._looks += 1
        if book is not None and master.ask("getPid") == book.pid:
            return read_book(master) if self._looks % LOOKS == 0 else book
        if book is not None:
            count = restore(book, master, self._caller)
            log.warning("the ROS master was started anew: %d nodes of %d are known to it again", count, len(book.nodes))
        return read_book(master)
