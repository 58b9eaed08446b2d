"""Connections of browsers: how many there may be, and how late a message may come.

Strangers have few, and for a short while; a visitor has enough for all pages. Pages hear the console's pulse, and stamp
what they send with its clock. A press that waited in a network that was cut, or for a console that hung, comes late: it
is refused. Stop never is.
"""

from __future__ import annotations

import asyncio
import ipaddress
import math
import socket
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Tuple

STRANGERS, OF_ADDRESS = 128, 32
"""Connections without a session: in all, and of one address."""
VISITORS, OF_SESSION = 600, 300
"""Connections with a session: in all, and of one session. A page takes six at most."""
PATIENCE = 10.0
"""s for which a stranger's connection stays open behind its last request."""
SWEEP_PERIOD = 1.0
"""s between two looks for strangers that are over their time."""
BACKLOG = 512
"""Connections that wait to be taken."""
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


@dataclass
class _Stranger:
    connection: Any  # a socket
    deadline: float


class Connections:
    """The open connections of one listener. Event loop only.

    A connection is a stranger's until a request on it has shown a session. Where strangers have too many, the oldest
    silent one of the address that has most is closed: a newcomer always gets in, and is known as soon as it has asked.

    Args:
        clock: s.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._strangers: dict[str, dict[Peer, _Stranger]] = {}  # by address, the one that was heard last at the end
        self._groups: dict[Peer, str] = {}
        self._visitors: dict[Peer, tuple[Any, str]] = {}  # socket and key of the session
        self._sweeping = False

    def add(self, peer: Any, connection: Any) -> None:
        """Somebody has connected. `connection`: the socket."""
        key, group = (peer[0], peer[1]), address_group(peer[0])
        self._visitors.pop(key, None)
        self._take(key)
        self._groups[key] = group
        own = self._strangers.setdefault(group, {})
        own[key] = _Stranger(connection, self._clock() + PATIENCE)
        if len(own) > OF_ADDRESS:
            self._make_room(group)
        elif len(self._groups) > STRANGERS:
            self._make_room(max(self._strangers, key=lambda each: len(self._strangers[each])))
        if not self._sweeping:
            self._sweeping = True
            asyncio.get_running_loop().call_later(SWEEP_PERIOD, self.sweep)

    def heard(self, peer: Peer) -> None:
        """A stranger has sent a whole request: more time for the next one."""
        group, found = self._groups.get(peer, ""), self._take(peer)
        if found is not None:
            found.deadline = self._clock() + PATIENCE
            self._groups[peer] = group
            self._strangers.setdefault(group, {})[peer] = found

    def admit(self, peer: Peer, session: str) -> bool:
        """A request has shown the key of a session; whether its connection may stay."""
        if peer not in self._groups:
            return True
        self._visitors = {each: kept for each, kept in self._visitors.items() if _is_open(kept[0])}
        own = sum(key == session for _, key in self._visitors.values())
        if own >= OF_SESSION or len(self._visitors) >= VISITORS:
            return False
        found = self._take(peer)
        if found is not None:
            self._visitors[peer] = (found.connection, session)
        return True

    @property
    def strangers(self) -> int:
        """How many connections without a session are open."""
        return sum(_is_open(each.connection) for own in self._strangers.values() for each in own.values())

    def _take(self, peer: Peer) -> _Stranger | None:
        """A stranger, who is none any more."""
        group = self._groups.pop(peer, None)
        if group is None:
            return None
        found = self._strangers[group].pop(peer)
        if not self._strangers[group]:
            del self._strangers[group]
        return found

    def _make_room(self, group: str) -> None:
        """Close one connection of an address: the oldest that says nothing, if there is one."""
        own = self._strangers[group]
        silent = (peer for peer, each in own.items() if not _has_asked(each.connection))
        self._close(next(silent, None) or next(iter(own)))

    def sweep(self) -> None:
        """Close the strangers that are over their time; comes again by itself as long as there are any."""
        now = self._clock()
        over = [
            peer
            for own in self._strangers.values()
            for peer, each in own.items()
            if each.deadline <= now or not _is_open(each.connection)
        ]
        for peer in over:
            self._close(peer)
        self._sweeping = bool(self._groups)
        if self._sweeping:
            asyncio.get_running_loop().call_later(SWEEP_PERIOD, self.sweep)

    def _close(self, peer: Peer) -> None:
        found = self._take(peer)
        if found is not None:
            with suppress(OSError):  # it has gone by itself
                found.connection.shutdown(socket.SHUT_RDWR)  # the loop, whose socket it is, sees its end


class CountedListener(socket.socket):
    """A listening socket that has its connections counted.

    `connections`: who counts; None: nobody.
    """

    connections: Connections | None = None
    _burst = 0

    @classmethod
    def on(cls, address: str, port: int, connections: Connections | None = None) -> CountedListener:
        """One that listens already, so that nobody can have its port meanwhile; port 0 takes a free one.

        An OSError when the address cannot be had.
        """
        listener = cls(socket.AF_INET6 if ":" in address else socket.AF_INET)
        listener.connections = connections
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((address, port))
            listener.listen(BACKLOG)  # who opens the address at once waits
        except OSError:
            listener.close()
            raise
        return listener

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


PERIOD = 0.5
"""s between two beats."""
LATE = 3.0
"""s from a press to its arrival at most."""
STAMP = "at"
"""Field of a message: when it was made, as `console_time`."""


def console_time() -> float:
    """Time of the clock that beats tell and messages are stamped with, s."""
    return time.monotonic()


def refusal_of_late(message: Mapping[str, Any]) -> str:
    """Why a message is not carried out, for people; empty: it is in time, or has no stamp."""
    stamp = message.get(STAMP)
    if not isinstance(stamp, (int, float)) or isinstance(stamp, bool) or not math.isfinite(stamp):
        return ""
    if console_time() - stamp <= LATE:
        return ""
    return (
        f"it came more than {LATE:g} s late, as the connection was interrupted: look, and press again if still wanted"
    )
