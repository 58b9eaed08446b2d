"""Sockets of this process that libqi holds and hands to nobody: its listening one, and those of its clients."""

from __future__ import annotations

import errno
import logging
import os
import socket
import struct
import threading
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator

from nao_sim_bridge.base.sizes import load_sizes

log = logging.getLogger("nao_sim.broker")

# States of a socket in the tables of /proc, and the timer of one whose other end has no room for more.
LISTENS, CONNECTED = "0A", "01"
NO_ROOM = "04"
# Where the kernel's tcp_info has the ms since data was sent last, and the bytes that the other end has acknowledged.
SENT_AND_TAKEN = struct.Struct("@44xI72xQ")
# A client that takes nothing for this time, s, though more waits than its system and ours can hold, is cut off: libqi
# would keep all that comes meanwhile. libqi itself gives such a connection up after 30 s.
STUCK = load_sizes().clients.stuck_s
# s between two looks while a client takes nothing, and otherwise: a look takes the kernel some ms.
LOOK_PERIOD, IDLE_PERIOD = 0.5, 2.0
FOLDER = "/proc/self/fd"
# What /proc calls the socket of a connection that libqi has not accepted yet, and how long that is waited for, s; it
# takes less than a millisecond.
NOT_ACCEPTED = "socket:[0]"
ACCEPT_LIMIT, ACCEPT_PAUSE = 5.0, 0.005


@dataclass(frozen=True)
class _Row:
    """A line of /proc's tables of TCP sockets."""

    link: str
    port: int
    state: str
    timer: str
    other_end: str


def free_port_on_exit(port: int) -> None:
    """Let the port be taken again at once after this process ends, however it ends.

    libqi binds without SO_REUSEADDR, so connections in TIME_WAIT would keep a killed simulator's port for a minute.
    With a linger time of 0, which accepted sockets inherit from the listening one, they are reset instead. Clients that
    try again and again connect as soon as libqi listens: the sockets that were accepted before that are set one by one.
    """
    for row in _rows(port, LISTENS):
        _reset_at_end(row.link)
    end = time.monotonic() + ACCEPT_LIMIT
    while NOT_ACCEPTED in [_reset_at_end(row.link) for row in _rows(port, CONNECTED)] and time.monotonic() < end:
        time.sleep(ACCEPT_PAUSE)


def _reset_at_end(link: str) -> str:
    """Have a connection reset when its socket is closed; returns the link."""
    for found in _sockets(link):
        found.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    return link


def is_taken(address: str, port: int) -> bool:
    """Whether the system gives a port to nobody now: a program listens there, or a connection has it."""
    with socket.socket() as probe:  # without SO_REUSEADDR, as libqi's
        try:
            probe.bind((address, port))
        except OSError as error:
            return error.errno == errno.EADDRINUSE
    return False


def is_listened_on(port: int) -> bool:
    """Whether a program listens on a port of this computer. Nobody is connected to for that."""
    return bool(_rows(port, LISTENS))


def has_clients(port: int) -> bool:
    """Whether somebody is connected to a port that this process listens on; true where the system does not tell."""
    return bool(_rows(port, CONNECTED)) or not _rows(port, LISTENS)


class StuckClients:
    """Cuts off the clients of a port that take nothing any more, in a thread of its own: those that are stopped."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._full: dict[str, tuple[int, float]] = {}  # bytes that had been taken, and s for which none were
        self._over = threading.Event()
        threading.Thread(target=self._run, name="watch of clients", daemon=True).start()

    def close(self) -> None:
        """Watch no more."""
        self._over.set()

    def _run(self) -> None:
        looked = time.monotonic()
        while not self._over.wait(LOOK_PERIOD if self._full else IDLE_PERIOD):
            looked, before = time.monotonic(), looked
            self._look(looked - before)

    def _look(self, passed: float) -> None:
        """Look at all; `passed` is s since the last look: what is beyond a period this process was itself stopped."""
        full = [row for row in _rows(self._port, CONNECTED) if row.timer == NO_ROOM]
        before, self._full = self._full, {}
        for row in full:
            with suppress(OSError):  # it has closed meanwhile
                self._look_at(row, min(passed, IDLE_PERIOD), *before.get(row.link, (-1, 0.0)))

    def _look_at(self, row: _Row, passed: float, known: int, full: float) -> None:
        for connection in _sockets(row.link):
            sent, taken = SENT_AND_TAKEN.unpack(connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, 128))
            full = full + passed if known == taken else min(0.001 * sent, IDLE_PERIOD)
            self._full[row.link] = (taken, full)
            if known == taken and full >= STUCK:
                log.warning("the client at %s has taken nothing for %.1f s: cut off", row.other_end, full)
                connection.shutdown(socket.SHUT_RDWR)


def _rows(port: int, state: str) -> list[_Row]:
    """The sockets of a local port that are in this state, of all processes."""
    found = []
    for table in ("/proc/self/net/tcp", "/proc/self/net/tcp6"):
        try:
            lines = Path(table).read_text(encoding="ascii").splitlines()[1:]
        except OSError:
            continue  # a kernel without this family
        for line in lines:
            if f":{port:04X} " not in line:
                continue
            _, local, other, now, _, timer, _, _, _, inode = line.split()[:10]
            if now == state and _port(local) == port:
                found.append(_Row(f"socket:[{inode}]", port, now, timer[:2], f"port {_port(other)}"))
    return found


def _port(address: str) -> int:
    return int(address.rsplit(":", 1)[1], 16)


def _sockets(link: str) -> Iterator[socket.socket]:
    """The socket of this process that a descriptor leads to, as /proc spells it; none if there is none any more."""
    for descriptor in os.listdir(FOLDER) if os.path.isdir(FOLDER) else ():
        try:
            if os.readlink(f"{FOLDER}/{descriptor}") == link:
                with _copy(int(descriptor)) as found:
                    yield found
                return
        except OSError:
            continue  # a descriptor that closed meanwhile


@contextmanager
def _copy(descriptor: int) -> Iterator[socket.socket]:
    # A copy shares its mode with the original, and where Python has a default timeout (rospy sets one) it makes every
    # socket non-blocking that it gets to see.
    blocking = os.get_blocking(descriptor)
    with socket.socket(fileno=os.dup(descriptor)) as copy:
        os.set_blocking(descriptor, blocking)
        yield copy
