"""libqi's messages, written and read here where bytes are among the values.

libqi's Python binding sends bytes as text wherever any value may stand. On the wire such a value says of itself that it
is raw, as those of a robot do. The form of the messages is that of libqi (github.com/aldebaran/libqi, message.hpp and
binarycodec.cpp): 28 bytes of header, then the values one after the other, little-endian; any value is behind its
signature.
"""

from __future__ import annotations

import socket
import struct
from dataclasses import dataclass
from typing import Any, Callable, Sequence

_HEADER = struct.Struct("<4sIIHBBIII")
"""Magic number, id, size of what follows, version, type, flags, service, object, method."""
_MAGIC = b"\x42\xde\xad\x42"
CALL, REPLY = 1, 2
MAIN_OBJECT = 1
AUTHENTICATE, META_OBJECT = 8, 2
"""Numbers of methods: the first one of the service 0, the second one of every object."""
_LARGEST = 2**20
"""bytes of a message that is read: calls and answers of callbacks hold nothing, or little."""


def packed(value: Any) -> bytes:
    """A value behind its signature, as libqi sends what a method takes as any value; a TypeError for others."""
    signature, content = _value(value)
    return text(signature) + content


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
        return "s", text(value)
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


def text(content: str) -> bytes:
    """A text as a value of that type."""
    return _raw(content.encode())


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
    "s": text,
    "r": _raw,
    **{code: struct.Struct(f"<{form}").pack for code, form in _NUMBERS.items()},
}
"""How a parameter of a declared type is written, by its signature."""


@dataclass(frozen=True)
class Message:
    """One message: its number, its kind, whose method it is about, and what is in it."""

    number: int
    kind: int
    service: int
    target: int
    method: int
    content: bytes


class Messages:
    """libqi's messages over a connection; one thread may send while another one reads."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection

    def send(self, message: Message) -> None:
        """Send one. An OSError when the connection does not take it."""
        where = (message.service, message.target, message.method)
        self._socket.sendall(_HEADER.pack(_MAGIC, message.number, len(message.content), 0, message.kind, 0, *where))
        self._socket.sendall(message.content)

    def receive(self) -> Message:
        """The next one. An OSError when the connection has ended, or something else came."""
        magic, number, size, _, kind, _, *where = _HEADER.unpack(self._read(_HEADER.size))
        if magic != _MAGIC or size > _LARGEST:
            raise ConnectionError("it sent something else than libqi's messages")
        return Message(number, kind, *where, self._read(size))

    def _read(self, count: int) -> bytes:
        read = bytearray()
        while len(read) < count:
            part = self._socket.recv(count - len(read))
            if not part:
                raise ConnectionError("it has closed the connection")
            read += part
        return bytes(read)
