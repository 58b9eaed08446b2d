"""What runs, as the ROS master tells it, and calls of services: without being a node, for that takes half a second."""

from __future__ import annotations

import http.client
import os
import socket
import struct
import xmlrpc.client
from collections.abc import Mapping
from io import BytesIO
from typing import Any
from urllib.parse import urlparse

from .errors import CommandFailed, StackMissing

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
