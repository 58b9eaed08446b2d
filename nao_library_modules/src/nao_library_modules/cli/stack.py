"""The servers of one robot: which robot is meant, which servers it has, what they, or their code, say of themselves.

`Graph` asks the ROS master and calls services without being a node, for that takes half a second.
"""

from __future__ import annotations

import http.client
import os
import socket
import struct
import xmlrpc.client
from collections.abc import Mapping, Sequence
from functools import lru_cache
from io import BytesIO
from typing import TYPE_CHECKING, Any
from urllib.parse import urlparse

import click

from ..core.errors import of_those
from ..core.server_types import ACTIONS, DESCRIBE, servers_among, those_in
from .output import CommandFailed, StackMissing, plain

if TYPE_CHECKING:
    from nao_library_msgs.srv import DescribeFunctionsResponse, ListBehaviorsRequest, ListBehaviorsResponse

    from ..core.goal_checks import GoalCheck


DEFAULT_MASTER = "http://localhost:11311"
LIMIT = 10.0
"""s that master and services have for an answer."""
START = "roslaunch nao_library nao_sim.launch, or nao.launch nao_ip:=ROBOT"
"""What starts the servers."""
CALLER = "/nao_command"


class _Transport(xmlrpc.client.Transport):
    """XML-RPC over HTTP that does not wait for ever."""

    def __init__(self, limit: float) -> None:
        super().__init__()
        self._limit = limit

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = self._limit
        return connection


class Graph:
    """The master of this shell, asked when something is wanted of it. `limit`: s that an answer may take."""

    def __init__(self, limit: float) -> None:
        self.uri = os.environ.get("ROS_MASTER_URI") or DEFAULT_MASTER
        self._limit = limit
        self._master = xmlrpc.client.ServerProxy(self.uri, transport=_Transport(limit))
        self._state: tuple[list[str], dict[str, list[str]]] | None = None

    def services(self) -> list[str]:
        """Full names of all services."""
        return self._system()[0]

    def topic_types(self) -> dict[str, str]:
        return dict(self._ask("getTopicTypes")[2])

    def subscribed(self) -> dict[str, list[str]]:
        """Topic -> nodes that read it."""
        return self._system()[1]

    def parameter(self, name: str) -> Any:
        """Value of a parameter by its full name; None if there is none."""
        code, _, value = self._ask("getParam", name)
        return value if code == 1 else None

    def alive(self, service: str) -> bool:
        """Whether the node of a service still answers; the service is not called."""
        header = {"callerid": CALLER, "service": service, "md5sum": "*", "probe": "1"}
        try:
            with self._connection(service) as connection, connection.makefile("rwb") as stream:
                _write_header(stream, header)
                _read_header(stream)
        except (StackMissing, OSError, EOFError):
            return False
        return True

    def call(self, service: str, kind: type, request: Any, patient: bool = False) -> Any:
        """Call a service.

        `service`: its full name. `patient`: wait for the answer as long as the connection stands, for a service that
        takes its time. Raises StackMissing if it is not there; CommandFailed if it refuses, or its type is another one.
        """
        try:
            with self._connection(service) as connection, connection.makefile("rwb") as stream:
                header = {"callerid": CALLER, "service": service, "md5sum": kind._md5sum, "type": kind._type}
                _write_header(stream, header)
                answer = _read_header(stream)
                if "error" in answer:
                    raise CommandFailed(f"{service}: {answer['error']}")
                buffer = BytesIO()
                request.serialize(buffer)
                stream.write(struct.pack("<I", len(buffer.getvalue())) + buffer.getvalue())
                stream.flush()
                if patient:
                    connection.settimeout(None)
                succeeded = _read(stream, 1) == b"\x01"
                content = _read(stream, struct.unpack("<I", _read(stream, 4))[0])
        except (OSError, EOFError) as error:
            raise StackMissing(f"{service} does not answer: {error or 'the connection was closed'}") from None
        if not succeeded:
            raise CommandFailed(f"{service}: {content.decode(errors='replace')}")
        response = kind._response_class()
        response.deserialize(content)
        return response

    def _connection(self, service: str) -> socket.socket:
        code, _, uri = self._ask("lookupService", service)
        if code != 1:
            raise StackMissing(f"there is no service {service}")
        place = urlparse(uri)
        return socket.create_connection((place.hostname, place.port), timeout=self._limit)

    def _system(self) -> tuple[list[str], dict[str, list[str]]]:
        if self._state is None:
            _, _, (_, subscribers, services) = self._ask("getSystemState")
            self._state = ([name for name, _ in services], dict(subscribers))
        return self._state

    def _ask(self, method: str, *arguments: Any) -> Any:
        try:
            return getattr(self._master, method)(CALLER, *arguments)
        except (OSError, xmlrpc.client.Error, http.client.HTTPException) as error:
            reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
            remedy = f"start the robot's stack ({START}), or set ROS_MASTER_URI to where it runs"
            raise StackMissing(f"there is no ROS master at {self.uri} ({reason}): {remedy}") from None


def _write_header(stream: Any, fields: Mapping[str, str]) -> None:
    lines = [f"{name}={value}".encode() for name, value in fields.items()]
    content = b"".join(struct.pack("<I", len(line)) + line for line in lines)
    stream.write(struct.pack("<I", len(content)) + content)
    stream.flush()


def _read_header(stream: Any) -> Mapping[str, str]:
    content = _read(stream, struct.unpack("<I", _read(stream, 4))[0])
    fields, begin = {}, 0
    while begin < len(content):
        (length,) = struct.unpack_from("<I", content, begin)
        name, _, value = content[begin + 4 : begin + 4 + length].decode(errors="replace").partition("=")
        fields[name] = value
        begin += 4 + length
    return fields


def _read(stream: Any, count: int) -> bytes:
    content = stream.read(count)
    if len(content) < count:
        raise EOFError
    return content


# --- the servers of a robot -------------------------------------------------------------------------------------------

SIMULATOR = "nao_sim"
BEHAVIORS = "NaoBehavior/list"


class Stack:
    """Servers of one namespace. Nothing is asked before it is needed, and each question once.

    Attributes:
        silent: Servers that the master knows and that did not answer.

    Args:
        namespace: Of the robot, as it was given; None: that of the environment, or of the only robot there is.
        limit: s that an answer may take.
    """

    def __init__(self, namespace: str | None = None, limit: float = LIMIT) -> None:
        self.graph = Graph(limit)
        self._given = namespace if namespace is not None else os.environ.get("ROS_NAMESPACE") or None
        self._namespace: str | None = None
        self.silent: list[str] = []
        self._described: dict[tuple[Any, ...], Any] = {}

    @property
    def namespace(self) -> str:
        """Of the robot, with a slash at both ends.

        Raises click.UsageError if there are several robots and none was chosen, or not the one that was.
        """
        if self._namespace is None:
            self._namespace = self._choose()
        return self._namespace

    def robots(self) -> list[str]:
        """Namespaces that have servers, with a slash at both ends."""
        return sorted({name.rpartition("/")[0] + "/" for name in self._all_servers()})

    def servers(self) -> list[str]:
        """Names of the robot's servers. Raises StackMissing if it has none."""
        return sorted(those_in(self.namespace, self._all_servers()), key=str.lower)

    def server(self, name: str) -> str:
        """Full name of a server; `lights`, `naolights` and `NaoLights` are the same.

        Raises StackMissing if it does not run, click.UsageError if there is no such server.
        """
        servers = self.servers()
        for server in servers:
            if same_server(server, name):
                return self.namespace + server
        if any(same_server(known, name) for known in ACTIONS):
            remedy = "its node ended, or was not launched (see its log, or launch the stack again)"
            raise StackMissing(f"the server {name} does not run: {remedy}; there are {', '.join(servers)}")
        if f"{self.namespace}{name}/goal" in self.graph.subscribed():
            raise click.UsageError(
                f"the action {name} has no service {name}/describe: its module makes it by self.serve"
            )
        raise click.UsageError(f"there is no server {name!r}{of_those(name, servers)}")

    def describe(
        self, server: str, functions: Sequence[str] = (), brief: bool = False, names: bool = False
    ) -> DescribeFunctionsResponse:
        """What a server says about its functions and itself.

        Args:
            server: Its name, as `server` takes it.
            functions: Names of functions; all without.
            brief: True: only about itself.
            names: True: only names and help of the functions.
        """
        from nao_library_msgs.srv import DescribeFunctions, DescribeFunctionsRequest

        full = self.server(server)
        key = (full, brief, names, tuple(functions))
        if key not in self._described:
            request = DescribeFunctionsRequest(list(functions), names, brief)
            self._described[key] = self.graph.call(full + DESCRIBE, DescribeFunctions, request)
        return self._described[key]

    def described(
        self, functions: Sequence[str] = (), brief: bool = False, names: bool = False
    ) -> list[tuple[str, DescribeFunctionsResponse]]:
        """Servers that answer, with what they say, as `describe` takes it; `silent` has the others from then on.

        Raises StackMissing if none answers.
        """
        found, missing = [], {}
        for name in self.servers():
            try:
                found.append((name, self.describe(name, functions, brief, names)))
            except StackMissing as error:  # a node that died without a word is in the master's books for ever
                missing[name] = error
        self.silent = list(missing)
        if not found:
            raise next(iter(missing.values()))
        return found

    def connected(self, server: str) -> bool:
        """Whether a server reaches its robot at this moment."""
        self._described.clear()
        return bool(self.describe(server, brief=True).connected)

    def check(self, server: str, goals: Sequence[Any]) -> GoalCheck:
        """Have a server check goals.

        `goals`: in the order in which they would be sent. Raises NotValidated if it is not there, or cannot tell.
        """
        from nao_library_msgs.srv import CheckGoals

        from ..core.describe import CHECK, NotValidated, check_request, read_response

        try:
            return read_response(self.graph.call(self.server(server) + CHECK, CheckGoals, check_request(goals)))
        except click.ClickException as error:
            raise NotValidated(error.message) from None

    def robot_address(self) -> tuple[str, int]:
        """IP and port of the robot, as its servers know it."""
        for _, told in self.described(brief=True):
            ip, _, port = told.robot.rpartition(":")
            if ip and port.isdigit():
                return ip, int(port)
        raise StackMissing("no server knows the address of the robot")

    def service(self, name: str) -> str:
        """Full name of a service: that of this robot, or that which all robots share.

        Raises StackMissing if there is none.
        """
        services = self.graph.services()
        for full in (self.namespace + name, "/" + name):
            if full in services:
                return full
        missing = f"there is no service {self.namespace}{name}"
        raise StackMissing(f"{missing}: is this a simulated robot?" if name.startswith(SIMULATOR) else missing)

    def behaviors(self, name: str = "") -> list[dict[str, Any]]:
        """The stored behaviours, or the one of a name, as plain values."""
        from nao_library_msgs.srv import ListBehaviorsRequest

        return plain(self.list_behaviors(ListBehaviorsRequest(name=name)))["behaviors"]

    def list_behaviors(self, request: ListBehaviorsRequest, patient: bool = False) -> ListBehaviorsResponse:
        """What the server of behaviours answers; see `Graph.call`."""
        from nao_library_msgs.srv import ListBehaviors

        return self.graph.call(self.service(BEHAVIORS), ListBehaviors, request, patient)

    def _all_servers(self) -> list[str]:
        listened = self.graph.subscribed()
        return [name for name in servers_among(self.graph.services()) if f"{name}/goal" in listened]

    def _choose(self) -> str:
        robots = self.robots()
        if not robots:
            raise StackMissing(f"no robot's servers run at {self.graph.uri}: start them with {START}")
        if self._given is not None:
            wanted = "/" + self._given.strip("/") + "/" if self._given.strip("/") else "/"
            if wanted in robots:
                return wanted
            known = [_plain(robot) for robot in robots]
            raise StackMissing(f"there is no robot {_plain(wanted)!r}{of_those(_plain(wanted), known)}")
        if len(robots) > 1 and "/" not in robots:
            raise click.UsageError(f"choose a robot with --robot; there are {', '.join(map(_plain, robots))}")
        return "/" if "/" in robots else robots[0]


def described_by_code(
    server: str = "", functions: Sequence[str] = (), brief: bool = False, names: bool = False
) -> list[tuple[str, DescribeFunctionsResponse]]:
    """Servers with what `Stack.describe` would tell if they ran, as far as the code knows.

    `server`: only this one; all without. Raises click.UsageError if there is no such server.
    """
    from nao_library_msgs.srv import DescribeFunctionsRequest

    servers = _servers_of_code()
    chosen = [found for found in servers if not server or same_server(found.name, server)]
    if not chosen:
        raise click.UsageError(f"there is no server {server!r}{of_those(server, [found.name for found in servers])}")
    request = DescribeFunctionsRequest(list(functions), names, brief)
    return [(found.name, found.service.answer(request)) for found in chosen]


@lru_cache(maxsize=None)
def _servers_of_code() -> list[Any]:
    from ..core.describe import offline_servers

    return offline_servers()


def _plain(namespace: str) -> str:
    """A robot's namespace as it is given on the command line."""
    return namespace.strip("/") or "/"


def same_server(server: str, name: str) -> bool:
    """Whether a name means a server: `lights` and `naolights` mean NaoLights."""
    return _short(server) == _short(name)


def _short(name: str) -> str:
    bare = name.lower().replace("_", "").replace("-", "")
    return bare[3:] if bare.startswith("nao") else bare
