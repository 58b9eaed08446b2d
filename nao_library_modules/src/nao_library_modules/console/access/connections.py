"""How many connections there may be: few of strangers, and for a short while; enough for all pages of a visitor."""

from __future__ import annotations

import asyncio
import ipaddress
import socket
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Tuple

STRANGERS, OF_ADDRESS = 128, 32
"""Connections without a session: in all, and of one address."""
VISITORS, OF_SESSION = 600, 300
"""Connections with a session: in all, and of one session. A page takes six at most."""
PATIENCE = 10.0
"""s for which a stranger's connection stays open behind its last request."""
SWEEP_PERIOD = 1.0
"""s between two looks for strangers that are over their time."""
BURST = 16
"""Connections that are accepted before the event loop turns to what else there is."""
Peer = Tuple[str, int]
"""Address and port of the other end."""


def address_group(address: str) -> str:
    """Whose address it is: itself, or its network of 64 bits where a host has all addresses of one."""
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if found.version == 4:
        return address
    mapped = found.ipv4_mapped
    return str(mapped) if mapped else str(ipaddress.ip_network((int(found) >> 64 << 64, 64)))


class Connections:
    """The open connections of one listener. Event loop only.

    A connection is a stranger's until a request on it has shown a session. Where strangers have too many, the oldest
    silent one of the address that has most is closed: a newcomer always gets in, and is known as soon as it has asked.

    Args:
        clock: s.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._strangers: dict[Peer, tuple[Any, float]] = {}  # socket and deadline; the oldest first
        self._visitors: dict[Peer, tuple[Any, str]] = {}  # socket and key of the session
        self._sweeping = False

    def add(self, peer: Any, connection: Any) -> None:
        """Somebody has connected. `connection`: the socket."""
        key = (peer[0], peer[1])
        self._visitors.pop(key, None)
        self._strangers.pop(key, None)
        self._strangers[key] = (connection, self._clock() + PATIENCE)
        if len(self._strangers) > OF_ADDRESS:
            self._make_room()
        if not self._sweeping:
            self._sweeping = True
            asyncio.get_running_loop().call_later(SWEEP_PERIOD, self._sweep)

    def heard(self, peer: Peer) -> None:
        """A stranger has sent a whole request: more time for the next one."""
        found = self._strangers.pop(peer, None)
        if found is not None:
            self._strangers[peer] = (found[0], self._clock() + PATIENCE)

    def admit(self, peer: Peer, session: str) -> bool:
        """A request has shown the key of a session; whether its connection may stay."""
        if peer not in self._strangers:
            return True
        self._visitors = {each: kept for each, kept in self._visitors.items() if _is_open(kept[0])}
        own = sum(key == session for _, key in self._visitors.values())
        if own >= OF_SESSION or len(self._visitors) >= VISITORS:
            return False
        connection, _ = self._strangers.pop(peer)
        self._visitors[peer] = (connection, session)
        return True

    def __len__(self) -> int:
        return sum(_is_open(each) for each, _ in (*self._strangers.values(), *self._visitors.values()))

    def _make_room(self) -> None:
        """Close what is too much, the oldest of the address that has most first."""
        self._forget_closed()
        while self._strangers:
            counts = Counter(address_group(address) for address, _ in self._strangers)
            most, count = counts.most_common(1)[0]
            if count <= OF_ADDRESS and len(self._strangers) <= STRANGERS:
                return
            own = [peer for peer in self._strangers if address_group(peer[0]) == most]
            self._close(next((peer for peer in own if not _has_asked(self._strangers[peer][0])), own[0]))

    def _sweep(self) -> None:
        self._forget_closed()
        now = self._clock()
        for peer in [peer for peer, (_, deadline) in self._strangers.items() if deadline <= now]:
            self._close(peer)
        self._sweeping = bool(self._strangers)
        if self._sweeping:
            asyncio.get_running_loop().call_later(SWEEP_PERIOD, self._sweep)

    def _forget_closed(self) -> None:
        self._strangers = {peer: kept for peer, kept in self._strangers.items() if _is_open(kept[0])}

    def _close(self, peer: Peer) -> None:
        connection, _ = self._strangers.pop(peer)
        with suppress(OSError):  # it has gone by itself
            connection.shutdown(socket.SHUT_RDWR)  # the loop, whose socket it is, sees its end


class CountedListener(socket.socket):
    """A listening socket that has its connections counted.

    `connections`: who counts; None: nobody.
    """

    connections: Connections | None = None
    _burst = 0

    def accept(self) -> tuple[socket.socket, Any]:
        """As that of sockets; says that nobody is there after each BURST, so that a flood is no hold-up."""
        if self._burst >= BURST:
            self._burst = 0
            raise BlockingIOError
        try:
            connection, peer = super().accept()
        except OSError:
            self._burst = 0
            raise
        self._burst += 1
        if self.connections is not None:
            self.connections.add(peer, connection)
        return connection, peer


def _has_asked(connection: Any) -> bool:
    """Whether something has come that was not looked at yet."""
    try:
        return bool(connection.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT))
    except OSError:
        return False


def _is_open(connection: Any) -> bool:
    return connection.fileno() != -1
