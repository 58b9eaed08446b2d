"""Sessions of libqi: opened within a bounded time, and ended before the interpreter is.

A native thread that takes the GIL while the interpreter is finalised ends the process by `std::terminate`. Closing a
session makes all threads return from libqi; who closes it waits for that here.
"""

from __future__ import annotations

import contextlib
import logging
import os
import threading
import time
import weakref
from collections import defaultdict
from typing import Any, Callable, DefaultDict, Dict, Hashable, Optional

import qi

from .errors import RobotUnreachable
from .translate import connect_reason

logger = logging.getLogger("naoqi")

RUNNING = qi.FutureState.Running
MEMORY, READY = "ALMemory", "NAOqiReady"
QUIET_LIBQI = "qi.path.sdklayout=silent:qi.eventloop=warning"
"""libqi warns that it found no SDK around it; a program that only talks to a robot needs none. On a busy computer it
writes to the standard output, among the JSON of a program, that it has added a thread."""


class Live:
    """One session from its making to its loss. A session cannot be used again, so each has its own.

    Attributes:
        session: The `qi.Session`.
        heartbeat: The remote method that is called as heartbeat; None until it is connected.
        broken: Set when libqi reports the end of the session, and when the program wants it.
        services: Remote objects found so far, by name.
        lookups: Held while a remote object is looked for, by name.
        connected_at: When it was connected, in s of `Connection.answering_time`.
        start_watch: Knows whether NAOqi has restarted behind this session; None while that cannot be known.
    """

    def __init__(self, on_break: Callable[[], None] = lambda: None) -> None:
        """Make a session that is not connected.

        `on_break`: called in a thread of libqi when the connection breaks; not when `close` ends it.
        """
        qi.logging.setFilters(QUIET_LIBQI)
        self.session = qi.Session()
        self.heartbeat: Any = None
        self.broken = threading.Event()
        self.services: Dict[str, Any] = {}
        self.lookups: DefaultDict[str, threading.Lock] = defaultdict(threading.Lock)
        self.connected_at = 0.0
        self.start_watch: Optional[StartWatch] = None
        self._on_break = on_break
        self._link = self.session.disconnected.connect(self._break)

    @property
    def has_restarted(self) -> bool:
        """Whether NAOqi has restarted since."""
        return self.start_watch is not None and self.start_watch.has_restarted

    def close(self) -> None:
        """End the session: calls under way fail, also when the robot is silent."""
        # A program that ends must not be called back by libqi any more; a session that was never connected, or
        # is broken already, has nothing to take back and says so.
        with contextlib.suppress(RuntimeError):
            self.session.disconnected.disconnect(self._link)
        self.session.close()
        if self.start_watch is not None:
            self.start_watch.end()

    def _break(self, _reason: str) -> None:
        self.broken.set()
        self._on_break()


class StartWatch:
    """Listens to the event that NAOqi raises when it has started with all its modules.

    A robot that boots can be reached before; the first event is the end of that start, and nothing is lost. Later
    ones come from a simulated robot only, whose NAOqi restarts while its network stays up.
    `has_restarted`: whether it has started again.
    """

    def __init__(self, live: Live) -> None:
        """Make a watch that listens to nothing yet."""
        self.has_restarted = False
        self._broken = live.broken
        self._ready = False
        self._subscriber: Any = None

    def begin(self, memory: Any, limit: float) -> None:
        """Listen from now on; RuntimeError when the robot cannot do that."""
        self._subscriber = _done(memory.subscriber(READY, _async=True), limit)
        _done(self._subscriber.signal.connect(self._on_ready, _async=True), limit)
        self._ready = bool(_done(memory.getEventHistory(READY, _async=True), limit))

    def _on_ready(self, *_: Any) -> None:
        if self._ready:
            self.has_restarted = True
            self._broken.set()
        self._ready = True

    def end(self) -> None:
        """Break the reference cycle through libqi: it holds this object, which holds the subscriber."""
        self._subscriber = None


def watch_starts(live: Live, limit: float) -> None:
    """Watch for restarts, if there is ALMemory already; its remote object is kept in `services`.

    Four requests, each after the answer to the one before; the first call of ALMemory needs one less for it.
    """
    watch = StartWatch(live)
    try:
        memory = live.services[MEMORY] = _done(live.session.service(MEMORY, _async=True), limit)
        watch.begin(memory, limit)
    except (RuntimeError, AttributeError) as error:
        live.services.pop(MEMORY, None)
        logger.debug("a new start of NAOqi cannot be noticed: %s", error)
    else:
        live.start_watch = watch


def open_live(host: str, port: int, limit: float, announce: Callable[[Live], None]) -> Live:
    """Connect to the NAOqi at an address.

    Raises RobotUnreachable if no NAOqi answers there.

    Args:
        host: Name or address of the robot.
        port: TCP port of NAOqi.
        limit: The attempt is given up after this time, in s.
        announce: Called with the session before it connects: closing it breaks the attempt off, and so does
            a `RobotUnreachable` raised here.
    """
    deadline = time.monotonic() + limit
    live = Live()
    announce(live)
    try:
        connect_session(live.session, host, port, limit)
        future = live.session.service("ServiceDirectory", _async=True)
        directory = _value(future, host, port, deadline - time.monotonic())
        live.heartbeat = directory.machineId
        watch_starts(live, deadline - time.monotonic())
        return live
    except RobotUnreachable:
        live.close()
        raise
    except (RuntimeError, AttributeError) as error:
        live.close()
        reason = f"what answers there is no NAOqi ({error})"
        raise RobotUnreachable(host, port, reason, "that this is the port of NAOqi") from error


def connect_session(session: Any, host: str, port: int, limit: float) -> None:
    """Connect a session. Raises RobotUnreachable if no NAOqi answers there within the limit (s)."""
    _value(session.connect(f"tcp://{host}:{port}", _async=True), host, port, limit)


def answered(future: Any, limit: float) -> bool:
    """Wait for a future.

    Asked twice: a program that was itself stopped for a while finds the limit over and the answer waiting, and needs
    only a moment to read it. Returns whether it is finished; False when the limit (s) is over.
    """
    for part in (0.8, 0.2):
        if future.wait(max(0, int(1000.0 * part * limit))) != RUNNING:
            return True
    return False


def _done(future: Any, limit: float) -> Any:
    if not answered(future, limit):
        raise RuntimeError(f"no answer within {limit:.1f} s")
    if future.hasError():
        raise RuntimeError(future.error())
    return future.value()


def _value(future: Any, host: str, port: int, limit: float) -> Any:
    if not answered(future, limit):
        reason = f"no answer as NAOqi would give it within {limit:.1f} s"
        raise RobotUnreachable(host, port, reason, "that the robot is on, and that this is the port of NAOqi")
    if future.hasError():
        raise RobotUnreachable(host, port, *connect_reason(future.error()))
    return future.value()


class Presence:
    """What may be inside libqi: threads that wait in it, callbacks that it holds, jobs that answer its calls."""

    def __init__(self) -> None:
        self._inside: Dict[Hashable, Optional[int]] = {}  # a dictionary: its single operations need no lock
        self._left = threading.Condition()  # wakes waiting threads
        self._awaited = False

    def enter(self, one: Hashable, thread: Optional[int] = None) -> None:
        """Note an entry, and the thread that will leave, if it is known; runs at each call, so it must stay cheap."""
        self._inside[one] = thread

    def leave(self, one: Hashable) -> None:
        """Note a return; one without an entry is no error."""
        self._inside.pop(one, None)
        if self._awaited:
            with self._left:
                self._left.notify_all()

    def lend(self, callback: Any) -> None:
        """Track a callback that libqi holds, until its last reference is gone."""
        self.enter(weakref.ref(callback, self.leave))

    def wait_until_empty(self, limit: float) -> bool:
        """Wait up to `limit` s until all but the calling thread have returned; whether that was reached."""
        own = threading.get_ident()
        with self._left:
            self._awaited = True
            return self._left.wait_for(lambda: all(own in entry for entry in tuple(self._inside.items())), limit)


TASKS = "/proc/self/task"
LOOK_PERIOD = 0.002
"""s between two checks, in which other threads can take the GIL."""
LOOKS = 2
"""Consecutive checks that must find no thread at work: at the first, a thread may wait for the GIL held by it."""


def wait_until_idle(limit: float) -> bool:
    """Wait up to `limit` s until no native thread is running; whether that was reached."""
    end = time.monotonic() + limit
    looks = 0
    while looks < LOOKS:
        if time.monotonic() > end:
            return False
        time.sleep(LOOK_PERIOD)
        looks = 0 if _any_works() else looks + 1
    return True


def _any_works() -> bool:
    # A thread of libqi that has called Python is listed there too, as a dummy.
    own = {each.native_id for each in threading.enumerate() if not isinstance(each, threading._DummyThread)}
    return any(_works(task) for task in os.listdir(TASKS) if int(task) not in own)


def _works(task: str) -> bool:
    with contextlib.suppress(FileNotFoundError, ProcessLookupError), open(f"{TASKS}/{task}/stat") as file:
        return file.read().rpartition(") ")[2].startswith("R")
    return False  # it has ended
