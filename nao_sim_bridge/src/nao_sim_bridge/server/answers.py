"""Answers with bytes in them, which libqi's Python binding would make texts of; see `messages`.

libqi hands on a future that it has made itself as it is. So an answer with bytes goes once over a connection of this
process to itself: the simulator calls a method whose answer is written here, and libqi reads it as it reads a robot's.
"""

from __future__ import annotations

import socket
import struct
import threading
from dataclasses import replace
from typing import Any

import qi

from nao_sim_bridge.server.messages import (
    AUTHENTICATE,
    CALL,
    META_OBJECT,
    REPLY,
    Message,
    Messages,
    packed,
    text,
)

_LOCALHOST = "127.0.0.1"
_SERVICE, _METHOD = "answers", 100
_LIMIT = 10.0
"""s in which libqi of this process has to connect, and to send what it is waited for."""
_LOGGED_IN = 3
"""State of a login that is done."""


class Answers:
    """Makes libqi futures of values with bytes. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._closed = False
        self._session: Any = None
        self._socket: socket.socket | None = None
        self._messages: Messages | None = None
        self._take: Any = None

    def future(self, value: Any) -> Any:
        """A future with this value.

        Raises:
            RuntimeError: The connection has ended; the next answer gets another one, unless this is closed.
        """
        content = packed(value)
        with self._lock:
            if self._closed:
                raise RuntimeError("bytes cannot be answered any more: the simulator is closing")
            try:
                if self._messages is None:
                    self._connect()
                future = self._take(_async=True)
                _reply(self._messages, self._messages.receive(), content)
            except (OSError, RuntimeError) as error:
                self._disconnect()  # what is on its way would be taken for the next answer
                raise RuntimeError(f"bytes cannot be answered: {error}") from error
        return future

    def close(self) -> None:
        """Answer no more."""
        with self._lock:
            self._closed = True
            self._disconnect()

    def _disconnect(self) -> None:
        if self._session is not None:
            self._session.close()
        if self._socket is not None:
            self._socket.close()
        self._session = self._socket = self._messages = self._take = None

    def _connect(self) -> None:
        self._session = session = qi.Session()
        session.listenStandalone(f"tcp://{_LOCALHOST}:0")
        directory = session.service("ServiceDirectory")
        with socket.create_server((_LOCALHOST, 0)) as door:
            door.settimeout(_LIMIT)
            address = f"tcp://{_LOCALHOST}:{door.getsockname()[1]}"
            number = directory.registerService((_SERVICE, 0, directory.machineId(), 0, [address], "", b""))
            directory.serviceReady(number)
            found = session.service(_SERVICE, _async=True)
            self._socket, _ = door.accept()
        self._socket.settimeout(_LIMIT)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        messages = Messages(self._socket)
        _introduce(messages)
        self._take, self._messages = found.value().take, messages


def _introduce(messages: Messages) -> None:
    """Let libqi log in, and tell it of the one method."""
    state = struct.pack("<I", 1) + text("__qi_auth_state") + text("I") + struct.pack("<I", _LOGGED_IN)
    _reply(messages, _call_of(messages, AUTHENTICATE), state)
    nothing = struct.pack("<I", 0)
    method = text("m") + text("take") + text("()") + text("") + nothing + text("")
    methods = struct.pack("<III", 1, _METHOD, _METHOD) + method
    signals = properties = nothing
    _reply(messages, _call_of(messages, META_OBJECT), methods + signals + properties + text(""))


def _call_of(messages: Messages, method: int) -> Message:
    call = messages.receive()
    if (call.kind, call.method) != (CALL, method):
        raise RuntimeError(f"libqi called {call.method} where it used to call {method}")
    return call


def _reply(messages: Messages, call: Message, content: bytes) -> None:
    messages.send(replace(call, kind=REPLY, content=content))
