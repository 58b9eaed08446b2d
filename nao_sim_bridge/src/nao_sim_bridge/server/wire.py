"""Calls of modules of clients whose arguments hold bytes, in libqi's own messages."""

from __future__ import annotations

import socket
import struct
import threading
from contextlib import suppress
from typing import Any, Iterable, Iterator, Sequence

import qi

from nao_sim_bridge.naoqi.binding.client_calls import GIVEN_UP
from nao_sim_bridge.server.messages import AUTHENTICATE, CALL, MAIN_OBJECT, REPLY, Message, Messages, text

_CONNECT = 5.0
"""s for a connection to one address of a client, and for its greeting."""


class Wires:
    """The connections over which modules of clients get bytes, one a program. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._wires: dict[tuple[str, ...], _Wire] = {}

    def call(self, endpoints: Sequence[str], service: int, method: int, arguments: bytes) -> Any:
        """Call a method.

        Args:
            endpoints: Where the module's program listens, as the service directory has it.
            service, method: Their numbers.
            arguments: As `packed_arguments` gives them.

        Returns:
            A libqi future that ends when the call has; what it answers is not read.

        Raises:
            RuntimeError: The program cannot be reached.
        """
        return self._wire(tuple(endpoints)).call(service, method, arguments)

    def _wire(self, endpoints: tuple[str, ...]) -> _Wire:
        """The connection to a program; a new one is made without the lock: a program that hangs holds up no other."""
        with self._lock:
            wire = self._wires.get(endpoints)
        if wire is not None and wire.open:
            return wire
        made = _Wire(_addresses(endpoints))
        with self._lock:
            self._wires = {each: kept for each, kept in self._wires.items() if kept.open}  # of programs that run
            wire = self._wires.setdefault(endpoints, made)
        if wire is not made:  # somebody else was faster
            made.close()
        return wire

    def close(self) -> None:
        with self._lock:
            wires, self._wires = list(self._wires.values()), {}
        for wire in wires:
            wire.close()


def _addresses(endpoints: Sequence[str]) -> Iterator[tuple[str, int]]:
    """Where to connect to, this computer first."""
    addresses = [each[len("tcp://") :].rpartition(":") for each in endpoints if each.startswith("tcp://")]
    for host, _, port in sorted(addresses, key=lambda address: not address[0].startswith("127.")):
        yield host, int(port)


class _Wire:
    """A connection to the program of a client."""

    def __init__(self, addresses: Iterable[tuple[str, int]]) -> None:
        self._socket = _connected(addresses)
        self._messages = Messages(self._socket)
        self._lock = threading.Lock()
        self._calls: dict[int, Any] = {}
        self._last = 0
        self.open = True
        try:
            self._messages.send(Message(0, CALL, 0, 0, AUTHENTICATE, struct.pack("<I", 0)))
            if self._messages.receive().kind != REPLY:
                raise RuntimeError("it takes no calls without a login")
        except OSError as error:
            self._socket.close()
            raise RuntimeError(f"its program does not answer: {error}") from error
        self._socket.settimeout(None)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack("@ll", round(GIVEN_UP), 0))
        threading.Thread(target=self._read, name="answers of a client", daemon=True).start()

    def call(self, service: int, method: int, arguments: bytes) -> Any:
        promise = qi.Promise()
        with self._lock:
            self._last += 1
            self._calls[self._last] = promise
            try:
                self._messages.send(Message(self._last, CALL, service, MAIN_OBJECT, method, arguments))
            except OSError as error:
                self.open = False
                del self._calls[self._last]
                raise RuntimeError(f"its program takes nothing: {error}") from error
        return promise.future()

    def close(self) -> None:
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def _read(self) -> None:
        with suppress(OSError):
            while True:
                message = self._messages.receive()
                with self._lock:
                    promise = self._calls.pop(message.number, None)
                if promise is not None and message.kind == REPLY:
                    promise.setValue(None)
                elif promise is not None:
                    promise.setError(_error(message.content))
        with self._lock:
            self.open = False
            calls, self._calls = list(self._calls.values()), {}
        self._socket.close()
        for promise in calls:
            promise.setError("its program has ended")


def _connected(addresses: Iterable[tuple[str, int]]) -> socket.socket:
    problems = []
    for address in addresses:
        try:
            return socket.create_connection(address, _CONNECT)
        except OSError as error:
            problems.append(f"{address[0]}:{address[1]}: {error}")
    raise RuntimeError(f"its program cannot be reached: {'; '.join(problems) or 'it has no address'}")


def _error(content: bytes) -> str:
    """The text of an error: a value that is a text, behind its signature."""
    head = text("s")
    if not content.startswith(head):
        return "the call has failed"
    return content[len(head) + 4 :].decode(errors="replace")
