"""The other end of the lines: what an owner that dies has started is stopped at once. No ROS.

One watch at a time has the place; others wait for its end and take over. So any process that starts nothing itself
may be one.
"""

from __future__ import annotations

import json
import logging
import os
import selectors
import socket
import threading
import time
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Callable

from naoqi.state import Worker

from .line import WatchConnector, peer_of, place

log = logging.getLogger(__name__)

LONGEST = 65536
"""Bytes of one line of text at most."""
PLACE_RETRY = 0.1
"""s until the next attempt to take a place whose watch does not answer."""


@dataclass(frozen=True)
class Owned:
    """Something that goes on."""

    owner: str  # name of the process
    what: str  # name of it
    cure: str  # the call that stops it: JSON of module, method, arguments
    since: float  # when it began, s of the monotonic clock, which all processes share
    until: float = float("inf")  # s of the same clock at which it is over by itself


@dataclass
class _Line:
    """One owner that is alive."""

    name: str = "a program"
    held: dict[int, Owned] = field(default_factory=dict)
    rest: bytes = b""


class OwnershipTable:
    """Owners and what they own. Plain state; one thread. The clock is monotonic, s."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lines: dict[Any, _Line] = {}

    def receive(self, owner: Any, data: bytes) -> None:
        """Take in what an owner sends. Raises ValueError if it is no message of an owner."""
        line = self._lines.setdefault(owner, _Line())
        *texts, line.rest = (line.rest + data).split(b"\n")
        if len(line.rest) > LONGEST:
            raise ValueError("a line without an end")
        for text in texts:
            self._note(line, json.loads(text))

    def _note(self, line: _Line, message: Any) -> None:
        if not isinstance(message, dict):
            raise ValueError(f"{message!r} is no message of an owner")
        if "owner" in message:
            line.name = str(message["owner"])
            log.debug("%s may own something", line.name)
        elif "release" in message:
            line.held.pop(message["release"], None)
        else:
            seconds = float(message["seconds"])
            cure, since = json.dumps(message["cure"]), float(message["since"])
            until = since + seconds if seconds else float("inf")
            line.held[int(message["hold"])] = Owned(line.name, str(message["what"]), cure, since, until)

    def remove(self, owner: Any) -> list[Owned]:
        """An owner has gone: what has to be stopped, in the order in which it began.

        What another process has begun to own since goes on: its walk is none of the dead one's.
        """
        line = self._lines.pop(owner, None)
        if line is None:
            return []
        now = self._clock()
        others = [each for other in self._lines.values() for each in other.held.values()]
        lost = [
            each
            for each in line.held.values()
            if each.until > now and not any(other.cure == each.cure and other.since > each.since for other in others)
        ]
        return list({each.cure: each for each in sorted(lost, key=lambda each: each.since)}.values())


class OwnerWatch:
    """Listens to the owners of a robot, or waits until the watch that does has gone.

    `address`: `ip:port` of the robot. `stop`: called with each thing that has lost its owner, in a thread of its own.
    """

    def __init__(self, address: str, stop: Callable[[Owned], None]) -> None:
        self._place = place(address)
        self._connector = WatchConnector(address)
        self._stop = stop
        self._worker = Worker("things without an owner")
        self._closed = threading.Event()
        self._wake, self._woken = socket.socketpair()
        self._thread = threading.Thread(target=self._run, name="watch of owners", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._closed.set()
        self._wake.close()
        self._thread.join(1.0)
        self._worker.close()

    def _run(self) -> None:
        while not self._closed.is_set():
            listener = socket.socket(socket.AF_UNIX)
            try:
                listener.bind(self._place)
                listener.listen()
            except OSError:
                listener.close()
                self._await_other()
                continue
            with listener:
                self._serve(listener)

    def _await_other(self) -> None:
        """Wait until the watch that has the place has gone, as an owner that owns nothing."""
        line = self._connector.connect()
        if line is None:
            self._closed.wait(PLACE_RETRY)
            return
        with line, selectors.DefaultSelector() as news:
            news.register(line, selectors.EVENT_READ)
            news.register(self._woken, selectors.EVENT_READ)
            news.select()

    def _serve(self, listener: socket.socket) -> None:
        table = OwnershipTable()
        with selectors.DefaultSelector() as news:
            news.register(listener, selectors.EVENT_READ)
            news.register(self._woken, selectors.EVENT_READ)
            while not self._closed.is_set():
                for key, _ in news.select():
                    if key.fileobj is listener:
                        line, _ = listener.accept()
                        if peer_of(line)[1] == os.getuid():
                            news.register(line, selectors.EVENT_READ)
                        else:
                            line.close()
                    elif key.fileobj is not self._woken and not self._receive(table, key.fileobj):
                        news.unregister(key.fileobj)
                        key.fileobj.close()
                        for owned in table.remove(key.fileobj):
                            self._worker.submit(partial(self._stop, owned))

    def _receive(self, table: OwnershipTable, line: Any) -> bool:
        """Take in what an owner sends; whether it lives on."""
        try:
            data = line.recv(LONGEST)
            if data:
                table.receive(line, data)
            return bool(data)
        except (OSError, ValueError, KeyError, TypeError) as error:
            log.warning("an owner says what nobody understands: %r", error)
            return False
