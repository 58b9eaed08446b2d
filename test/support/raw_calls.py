"""Calls in libqi's own messages, and what is on the wire in their answers: Python's libqi shows no types."""

from __future__ import annotations

import socket
import struct
from collections.abc import Iterator
from contextlib import suppress

from nao_sim_bridge.server.messages import AUTHENTICATE, CALL, MAIN_OBJECT, REPLY, Message, packed

LIMIT = 60.0
"""s for an answer."""
HEADER = struct.Struct("<4sIIHBBIII")
NUMBERS = {"b": "?", "c": "b", "C": "B", "w": "h", "W": "H", "i": "i", "I": "I", "l": "q", "L": "Q", "f": "f", "d": "d"}


class RawCalls:
    """A connection to a simulator; `session` is a client of it, which knows what there is."""

    def __init__(self, port, session):
        self._session = session
        self._socket = socket.create_connection(("127.0.0.1", port), LIMIT)
        # libqi sends header and content one after the other, the second when the first is acknowledged.
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)
        self._number = 0
        self._call(0, 0, AUTHENTICATE, struct.pack("<I", 0))

    def close(self):
        self._socket.close()

    def answer(self, service, method, *arguments):
        """(signature, content) of the answer of a method, as it is on the wire, without what any value adds."""
        number = next(each["serviceId"] for each in self._session.services() if each["name"] == service)
        for _, uid, returns, takes in self._ways(service, method, len(arguments)):
            with suppress(AttributeError, TypeError, struct.error):  # arguments of another type
                content = b"".join(map(written, parts(takes[1:-1]), arguments))
                return unwrapped(returns, self._call(number, MAIN_OBJECT, uid, content))
        raise LookupError(f"{service} has no {method}{arguments}")

    def _ways(self, service, name, count):
        """Rank, number, answer and parameters of each way to call a method, those that take any values first."""
        methods = self._session.service(service).metaObject()["methods"].items()
        ways = [
            (uid, each["returnSignature"], each["parametersSignature"]) for uid, each in methods if each["name"] == name
        ]
        fitting = [way for way in ways if len(list(parts(way[2][1:-1]))) == count]
        return sorted(((way[2].count("m"), *way) for way in fitting), reverse=True)

    def _call(self, service, target, method, content):
        self._number += 1
        message = Message(self._number, CALL, service, target, method, content)
        header = HEADER.pack(b"\x42\xde\xad\x42", message.number, len(content), 0, CALL, 0, service, target, method)
        self._socket.sendall(header + content)
        while True:
            _, number, size, _, kind, _, *_ = HEADER.unpack(self._read(HEADER.size))
            answer = self._read(size)
            if number == message.number:
                if kind != REPLY:
                    raise RuntimeError(unwrapped("m", answer))
                return answer

    def _read(self, count):
        read = bytearray()
        while len(read) < count:
            part = self._socket.recv(count - len(read))
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)
            if not part:
                raise ConnectionError("the simulator has closed the connection")
            read += part
        return bytes(read)


def parts(signature) -> Iterator[str]:
    """The types of a tuple's content, one after the other, without names."""
    depth, start, names = 0, 0, 0
    for at, letter in enumerate(signature):
        names += (letter == "<") - (letter == ">")
        if names or letter == ">":
            start = at + 1 if depth == 0 else start
            continue
        depth += (letter in "([{") - (letter in ")]}")
        if depth == 0:
            yield signature[start : at + 1]
            start = at + 1


def written(code, value):
    """An argument as its parameter takes it."""
    if code == "m":
        return packed(value)
    if code == "s":
        return struct.pack("<I", len(value.encode())) + value.encode()
    if code.startswith("["):
        return struct.pack("<I", len(value)) + b"".join(written(code[1:-1], each) for each in value)
    return struct.pack(f"<{NUMBERS[code]}", value)


def unwrapped(signature, content):
    """The signature and the value of what is on the wire, out of any value."""
    value, _ = _read_value(signature, content, 0)
    while isinstance(value, Dynamic):
        signature, value = value
    return signature, value


class Dynamic(tuple):
    """(signature, value): what stands where any value may."""


def _read_value(signature, content, at):
    kind = signature[0]
    if kind == "m":
        inner, at = _read_text(content, at)
        value, at = _read_value(inner, content, at) if inner != "v" else (None, at)
        return Dynamic((inner, value)), at
    if kind in "sr":
        return (_read_text if kind == "s" else _read_raw)(content, at)
    if kind == "[":
        count, at = _read_number("I", content, at)
        return _read_values([signature[1 : signature.rindex("]")]] * count, content, at)
    if kind == "(":
        values, at = _read_values(list(parts(signature[1 : signature.rindex(")")])), content, at)
        return tuple(values), at
    if kind == "{":
        count, at = _read_number("I", content, at)
        pair = list(parts(signature[1 : signature.rindex("}")]))
        values, at = _read_values(pair * count, content, at)
        return dict(zip(values[::2], values[1::2])), at
    if kind == "v":
        return None, at
    if kind == "o":
        return object, len(content)
    return _read_number(kind, content, at)


def _read_values(signatures, content, at):
    values = []
    for signature in signatures:
        value, at = _read_value(signature, content, at)
        values.append(value)
    return values, at


def _read_raw(content, at):
    count, at = _read_number("I", content, at)
    return content[at : at + count], at + count


def _read_text(content, at):
    text, at = _read_raw(content, at)
    return text.decode(), at


def _read_number(code, content, at):
    form = struct.Struct(f"<{NUMBERS[code]}")
    return form.unpack_from(content, at)[0], at + form.size
