"""The owner's end: reports to the watch what this process has started, for as long as it goes on. No ROS.

A line is a local socket. The system closes it at once when a process dies, however it dies.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import logging
import os
import socket
import struct
import sys
import threading
import time
from collections.abc import Hashable, Sequence
from typing import Any, Callable

from naoqi.errors import NaoError

from .rules import rules

log = logging.getLogger(__name__)

PEER = struct.Struct("3i")
"""Process, user and group at the other end of a line."""
RETRY = 0.1
"""s between two attempts to find a watch, while something is owned."""
REFRESH = 1.0
"""s in which what is started again and again is reported once."""

GOAL, SERVICE = "goal", "service"
"""Stand for modules in the cures of what is not the robot's: a goal of an action, then come the topic of its
cancellation and its id; and what a service without arguments ends, then come its name and that of the node."""

Ended = Callable[[Any], None]


def place(address: str) -> str:
    """Name of the socket of the watch of a robot, of this user and computer; it leaves no file behind."""
    return f"\0nao_library/owners/{os.getuid()}/{address}"


def peer_of(line: socket.socket) -> tuple[int, int]:
    """Process and user at the other end of a line: the name of its socket keeps nobody out."""
    process, user, _ = PEER.unpack(line.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, PEER.size))
    return process, user


class WatchConnector:
    """Connects to the watch of the robot at `ip:port`. A watch of another user is refused, and logged once."""

    def __init__(self, address: str) -> None:
        self._place = place(address)
        self._logged: tuple[int, int] | None = None

    def connect(self) -> socket.socket | None:
        """A line; None while there is no watch."""
        line = socket.socket(socket.AF_UNIX)
        line.setblocking(False)  # a watch that accepts no line is not waited for
        try:
            line.connect(self._place)
            line.settimeout(None)  # rospy gives all sockets 60 s, and a line that ends is the death of its owner
            peer = peer_of(line)
        except OSError:
            line.close()
            return None
        if peer[1] == os.getuid():
            return line
        line.close()
        if peer != self._logged:
            self._logged = peer
            log.error("process %d of user %d has the place of the watch: what dead processes leave goes on", *peer)
        return None


class OwnerLine:
    """The things that this process (`name`) owns of the robot at `ip:port`.

    Threads: any may hold and let go. A thread of its own finds the watch again when that has gone; it works only while
    something is owned. The lock guards all state and is held while a line of text is sent, which never waits.
    The clock is the monotonic one of the computer, s, by which the watch compares owners.
    """

    def __init__(self, address: str, clock: Callable[[], float] = time.monotonic) -> None:
        self.name = os.path.basename(sys.argv[0]) or "a program"
        self._connector = WatchConnector(address)
        self._clock = clock
        self._condition = threading.Condition()  # of an RLock
        self._held: dict[Hashable, dict[str, Any]] = {}
        self._numbers = itertools.count()
        self._socket: socket.socket | None = None
        self._thread: threading.Thread | None = None

    # --- what is owned ------------------------------------------------------------------------------------------------

    def hold(self, key: Hashable, what: str, cure: Sequence[Any], seconds: float = 0.0) -> None:
        """Own something from now on.

        Args:
            key: Of it in this process; one that was just reported is not reported again.
            cure: The call that stops it: module, method, arguments.
            seconds: How long it goes on at most; 0: until `let_go`.
        """
        with self._condition:
            now = self._clock()
            held = self._held.get(key)
            if held is not None and now < held["since"] + REFRESH:
                return
            if seconds:
                self._forget_old(now)
            number = next(self._numbers) if held is None else held["hold"]
            self._held[key] = {"hold": number, "what": what, "cure": list(cure), "seconds": seconds, "since": now}
            if self._socket is None:
                self._find_watch()  # which gets all there is
            else:
                self._send(self._held[key])

    def let_go(self, key: Hashable) -> None:
        with self._condition:
            held = self._held.pop(key, None)
            if held is not None:
                self._send({"release": held["hold"]})

    def sending(
        self, module: str, method: str, arguments: Sequence[Any], cure: Sequence[Any] | None = None
    ) -> Ended | None:
        """A call is about to be sent, see `naoqi.Connection.witness`; `cure` stops it, else the call of the rule."""
        rule = rules().get((module, method))
        if rule is None:
            return None
        cure = cure or [*rule.cure, rule.cure_arguments(arguments)]
        if rule.seconds:
            self.hold((rule.cure, str(cure)), rule.what, cure, rule.seconds)
            return None
        if method in rule.during:
            key = object()
            self.hold(key, rule.what, cure)
            return lambda _: self.let_go(key)
        if method in rule.begins and not rule.stands_still(arguments):
            self.hold(rule.cure, rule.what, cure)
            return None
        return lambda call: _succeeded(call) and self.let_go(rule.cure)

    def _forget_old(self, now: float) -> None:
        over = [key for key, held in self._held.items() if held["seconds"] and now > held["since"] + held["seconds"]]
        for key in over:
            self.let_go(key)

    # --- the line -----------------------------------------------------------------------------------------------------

    def _send(self, message: dict[str, Any]) -> None:
        if self._socket is None:
            return
        try:
            self._socket.sendall((json.dumps(message) + "\n").encode(), socket.MSG_DONTWAIT)
        except OSError:  # the watch has died, or takes nothing in any more
            with contextlib.suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)  # which the thread notices, and closes it

    def _find_watch(self) -> None:
        self._connect()
        if self._thread is None:
            self._thread = threading.Thread(target=self._keep, name="line of owner", daemon=True)
            self._thread.start()
        self._condition.notify_all()

    def _connect(self) -> None:
        self._socket = self._connector.connect()
        if self._socket is None:
            return
        self._send({"owner": self.name})
        for held in self._held.values():
            self._send(held)

    def _keep(self) -> None:
        while True:
            with self._condition:
                self._condition.wait_for(lambda: self._held or self._socket)
                if self._socket is None:
                    self._connect()
                line = self._socket
                if line is None:
                    self._condition.wait(RETRY)
                    continue
            with contextlib.suppress(OSError):
                line.recv(1)  # the watch never sends anything: what comes is the end of the line
            with self._condition:
                self._socket = None
                line.close()


def _succeeded(call: Any) -> bool:
    try:
        call.result(timeout=0)
    except NaoError:
        return False
    return True
