"""Calls of modules of clients whose arguments hold bytes: libqi's messages, written here.

libqi's Python binding sends bytes as text wherever a method takes any value, so a client gets the text of them. On the
wire such a value says of itself that it is raw, as those of a robot do. The form of the messages is that of libqi
(github.com/aldebaran/libqi, message.hpp and binarycodec.cpp): 28 bytes of header, then the arguments one after the
other, little-endian, each value behind its signature.
"""

from __future__ import annotations

import socket
import struct
import threading
from contextlib import suppress
from typing import Any, Callable, Iterable, Iterator, Sequence

import qi

from nao_sim_bridge.naoqi.binding.client_calls import GIVEN_UP

_HEADER = struct.Struct("<4sIIHBBIII")
"""Magic number, id, size of what follows, version, type, flags, service, object, method."""
_MAGIC = b"\x42\xde\xad\x42"
_CALL, _REPLY, _ERROR = 1, 2, 3
_MAIN_OBJECT = 1
_AUTHENTICATE = 8
_CONNECT = 5.0
"""s for a connection to one address of a client, and for its greeting."""
_LARGEST = 2**20
"""bytes of an answer: callbacks answer nothing, or little."""


def has_bytes(value: Any) -> bool:
    """Whether bytes are somewhere in a value."""
    if isinstance(value, (bytes, bytearray)):
        return True
    if isinstance(value, dict):
        return has_bytes([*value.keys(), *value.values()])
    return isinstance(value, (list, tuple)) and any(has_bytes(each) for each in value)


def packed(value: Any) -> bytes:
    """A value behind its signature, as libqi sends what a method takes as any value; a TypeError for others."""
    signature, content = _value(value)
    return _text(signature) + content


def packed_arguments(signature: str, arguments: Sequence[Any]) -> bytes | None:
    """The arguments of a method; None if some of its parameters are neither numbers, texts, bytes nor any value.

    Args:
        signature: Of its parameters, as its service has it: "(mm)", or "m" where it takes any number of values.
    """
    if signature == "m":
        return packed(tuple(arguments))
    codes = signature[1:-1]
    if len(codes) != len(arguments) or not set(codes) <= {"m", *_FIXED}:
        return None
    return b"".join(packed(value) if code == "m" else _FIXED[code](value) for code, value in zip(codes, arguments))


def _value(value: Any) -> tuple[str, bytes]:
    if value is None:
        return "v", b""
    if isinstance(value, bool):
        return "b", struct.pack("<?", value)
    if isinstance(value, int):
        return ("i", struct.pack("<i", value)) if -(2**31) <= value < 2**31 else ("l", struct.pack("<q", value))
    if isinstance(value, float):
        return "d", struct.pack("<d", value)
    if isinstance(value, str):
        return "s", _text(value)
    if isinstance(value, (bytes, bytearray)):
        return "r", _raw(value)
    if isinstance(value, tuple):
        return f"({'m' * len(value)})", b"".join(map(packed, value))
    if isinstance(value, list):
        return "[m]", struct.pack("<I", len(value)) + b"".join(map(packed, value))
    if isinstance(value, dict):
        return "{mm}", struct.pack("<I", len(value)) + b"".join(packed(k) + packed(v) for k, v in value.items())
    raise TypeError(f"libqi has no type for {type(value).__name__}")


def _raw(content: bytes) -> bytes:
    return struct.pack("<I", len(content)) + content


def _text(text: str) -> bytes:
    return _raw(text.encode())


_NUMBERS = {
    "b": "?",
    "c": "b",
    "C": "B",
    "w": "h",
    "W": "H",
    "i": "i",
    "I": "I",
    "l": "q",
    "L": "Q",
    "f": "f",
    "d": "d",
}
_FIXED: dict[str, Callable[[Any], bytes]] = {
    "s": _text,
    "r": _raw,
    **{code: struct.Struct(f"<{form}").pack for code, form in _NUMBERS.items()},
}
"""How a parameter of a declared type is written, by its signature."""


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
        self._lock = threading.Lock()
        self._calls: dict[int, Any] = {}
        self._last = 0
        self.open = True
        try:
            self._send(0, 0, 0, _AUTHENTICATE, struct.pack("<I", 0))
            if self._receive()[1] != _REPLY:
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
                self._send(self._last, service, _MAIN_OBJECT, method, arguments)
            except OSError as error:
                self.open = False
                del self._calls[self._last]
                raise RuntimeError(f"its program takes nothing: {error}") from error
        return promise.future()

    def close(self) -> None:
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def _send(self, number: int, service: int, target: int, method: int, content: bytes) -> None:
        header = _HEADER.pack(_MAGIC, number, len(content), 0, _CALL, 0, service, target, method)
        self._socket.sendall(header + content)

    def _receive(self) -> tuple[int, int, bytes]:
        """The id of a message, its type and its content; an OSError when the connection has ended."""
        magic, number, size, _, kind, *_ = _HEADER.unpack(self._read_bytes(_HEADER.size))
        if magic != _MAGIC or size > _LARGEST:
            raise ConnectionError("it sent something else than libqi's messages")
        return number, kind, self._read_bytes(size)

    def _read_bytes(self, count: int) -> bytes:
        read = bytearray()
        while len(read) < count:
            part = self._socket.recv(count - len(read))
            if not part:
                raise ConnectionError("it has closed the connection")
            read += part
        return bytes(read)

    def _read(self) -> None:
        with suppress(OSError):
            while True:
                number, kind, content = self._receive()
                with self._lock:
                    promise = self._calls.pop(number, None)
                if promise is not None and kind == _REPLY:
                    promise.setValue(None)
                elif promise is not None:
                    promise.setError(_error(content))
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
    head = _text("s")
    if not content.startswith(head):
        return "the call has failed"
    return content[len(head) + 4 :].decode(errors="replace")
