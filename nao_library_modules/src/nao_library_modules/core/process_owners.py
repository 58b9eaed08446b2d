"""What a process starts on the robot is noted while the process lives and stopped if it dies. No ROS.

Every process that calls the robot reports to the `OwnerWatch` of another process, by its `OwnerLine`, what it starts.
A line that breaks while something is noted has lost its owner, and the watch stops what was noted. One watch at a time
has the place; others wait for its end and take over. So any process that starts nothing itself may be one.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import logging
import os
import selectors
import socket
import struct
import sys
import threading
import time
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import Any, Callable

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, LOST_PATIENCE
from naoqi.state import Worker

from .files import config_file
from .nao_facts import MOTION

log = logging.getLogger(__name__)

FILE = "owned_calls.json"
FIRST, NONE = "first", "none"


@dataclass(frozen=True)
class OwnershipRule:
    """One kind of thing that goes on by itself."""

    what: str  # name of it, for texts
    module: str  # NAOqi module of the calls
    cure: tuple[str, str]  # module and method that stop it
    arguments: str  # what the cure takes of the arguments of the call: "names", "first" or "none"
    during: frozenset[str] = frozenset()  # methods that own it while they run
    begins: frozenset[str] = frozenset()  # methods after which it goes on
    ends: frozenset[str] = frozenset()  # methods that end what `begins` started
    seconds: float = 0.0  # how long it goes on after a method of `during` that has ended

    def cure_arguments(self, arguments: Sequence[Any]) -> list[Any]:
        if self.arguments == NONE or not arguments:
            return []
        first = arguments[0]
        if self.arguments == FIRST:
            return [first]
        return [[first] if isinstance(first, str) else [str(name) for name in first]]

    def stands_still(self, arguments: Sequence[Any]) -> bool:
        """Whether a method of `begins` ends the walk instead: all its speeds are 0."""
        speeds = [value for value in arguments if isinstance(value, (int, float)) and not isinstance(value, bool)]
        return bool(speeds) and not any(speeds)


@lru_cache(maxsize=1)
def rules() -> dict[tuple[str, str], OwnershipRule]:
    """Module and method of a call -> its rule."""
    owned = json.loads(config_file(FILE).read_text(encoding="utf-8"))["owned"]
    return {
        (rule.module, method): rule for rule in map(_rule, owned) for method in rule.during | rule.begins | rule.ends
    }


def _rule(entry: dict[str, Any]) -> OwnershipRule:
    named = {"from": "begins", "to": "ends"}
    fields = {named.get(name, name): value for name, value in entry.items()}
    for name in ("during", "begins", "ends"):
        fields[name] = frozenset(fields.get(name, ()))
    fields["cure"] = tuple(fields["cure"])
    return OwnershipRule(**fields)


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


class Stops:
    """Stops things of one robot.

    Args:
        robot: Its proxies and connection.
        elsewhere: Stops what is not the robot's, by its word in the place of a module: `GOAL`, with topic and id,
            `SERVICE`, with its name and that of the node that has died.
    """

    def __init__(self, robot: Any, elsewhere: Mapping[str, Callable[[str, str], None]]) -> None:
        self._robot = robot
        self._elsewhere = elsewhere

    def stop(self, owned: Owned) -> None:
        """Stop something; errors are logged."""
        module, method, arguments = json.loads(owned.cure)
        try:
            if module in self._elsewhere:
                self._elsewhere[module](method, arguments)
            else:
                self._robot.connection.wait_connected(LOST_PATIENCE)
                completed = self._completed(module, method, arguments)
                # Not waited for: a walk ends on both feet, and the next thing is to be stopped meanwhile.
                self._robot.proxy(module).call_async(method, *completed).add_done_callback(partial(_log_failure, owned))
        except NaoError as error:
            log.error("%s has died, and its %s may go on: %s", owned.owner, owned.what, error)
        else:
            log.warning("%s has died: its %s is stopped", owned.owner, owned.what)

    def _completed(self, module: str, method: str, arguments: list[Any]) -> list[Any]:
        """Joints in the place of chains; and the commanded angles, as the new target that ends the former."""
        if module != MOTION or not arguments:
            return arguments
        joints = [joint for name in arguments[0] for joint in self._ask(MOTION, "getBodyNames", name)]
        return [joints, self._ask(MOTION, "getAngles", joints, False), 1.0] if method == "setAngles" else [joints]

    def _ask(self, module: str, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(module).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)


def _log_failure(owned: Owned, call: Any) -> None:
    try:
        call.result(timeout=0)
    except NaoError as error:
        log.error("the %s of %s, which has died, may go on: %s", owned.what, owned.owner, error)
