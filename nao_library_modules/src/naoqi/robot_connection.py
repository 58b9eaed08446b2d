"""The connection to one robot: opened, watched, and opened again for as long as the program wants it.

Threads: a watching thread opens the session, measures its heartbeat and closes it when the robot is silent for too
long. A second one calls the listeners, so that a slow listener cannot delay the heartbeat. `live` is the one thing
that calls read, a single reference that changes in one step; everything else is guarded by one condition. The
connections of a process are shared: one for each address.
"""

from __future__ import annotations

import atexit
import gc
import logging
import math
import sys
import threading
import time
from types import FunctionType
from typing import Any, Callable, Dict, List, Optional, Set, Tuple

from .calls import TaskTable, Witness
from .errors import BadArguments, NaoError, RobotUnreachable
from .limits import (
    ANSWER_LIMIT,
    BOOT_LIMIT,
    DEFAULT_TIMING,
    EXIT_LIMIT,
    FIRST_MODULE_LIMIT,
    FLUSH_LIMIT,
    IDLE_LIMIT,
    READY_LIMIT,
    START_LIMIT,
    Timing,
)
from .session import RUNNING, Live, Presence, open_live, wait_until_idle, watch_starts
from .state import EventSubscriptions, Listener, Listeners, State
from .translate import connect_reason, is_unknown_service, unknown_module

logger = logging.getLogger("naoqi")

DEFAULT_PORT = 9559
SLICE_MS = 100
"""Wait for an answer, in ms, until it is seen whether the session still stands."""


class Connection:
    """The connection to the NAOqi at one address. Get it from `naoqi.connection`, which shares them.

    Attributes:
        host: Name or address of the robot.
        port: TCP port of NAOqi.
        timing: How patient it is; may be replaced at any time.
        live: The session while there is one, else None.
        generation: How many sessions there have been.
        latency: Round trip of the last heartbeat in s; None while not connected.
        last_error: What went wrong last, empty if nothing ever did.
        tasks: The posted calls of all proxies on this connection.
        presence: Threads and callbacks inside libqi on behalf of this connection.
        subscriptions: Event subscriptions to renew after a loss.
        used_modules: Names of the modules that programs have used, in any session.
        closers: Called first when it is closed, in its thread: they end what this process serves over it.
        witness: Called with module, method and arguments of each call before it is sent, where there is one; what it
            returns, if it is not None, is called at the end of the call, in a thread of libqi.
    """

    def __init__(self, host: str, port: int, timing: Timing) -> None:
        """Start connecting in the background."""
        self.host = host
        self.port = port
        self.timing = timing
        self.live: Optional[Live] = None
        self.generation = 0
        self.latency: Optional[float] = None
        self.last_error = ""
        self.tasks = TaskTable()
        self.presence = Presence()
        self._condition = threading.Condition()
        self._state = State.CONNECTING
        self._since = time.monotonic()
        self._failed_attempts = 0
        self._complained = False
        self._check = ""
        self._silent_since: Optional[float] = None
        self._answering: Tuple[float, Optional[float], float] = (0.0, time.monotonic(), math.inf)
        """s counted so far; since when more is counted, None while it is not; how much of it counts at most."""
        self._opening: Optional[Live] = None
        self._closing = threading.Event()
        self._listeners = Listeners(f"naoqi listeners {self.address}")
        self.subscriptions = EventSubscriptions(self)
        self.add_listener(self.subscriptions.on_state)
        self.used_modules: Set[str] = set()
        self.closers: List[Callable[[], None]] = []
        self.witness: Optional[Witness] = None
        self._watcher = threading.Thread(target=self._run, name=f"naoqi {self.address}", daemon=True)
        self._watcher.start()

    def __repr__(self) -> str:
        return f"<Connection {self.address} {'silent' if self.silent else self._state}>"

    @property
    def address(self) -> str:
        """`host:port`."""
        return f"{self.host}:{self.port}"

    @property
    def state(self) -> State:
        return self._state

    @property
    def silent(self) -> float:
        """How long a connected robot has answered nothing, s, if that is longer than `timing.silence`; else 0.

        Calls under way and new ones wait for it, until it answers or the connection is lost.
        """
        since = self._silent_since
        return 0.0 if since is None else time.monotonic() - since

    def answering_time(self) -> float:
        """A clock, s, that stands still while a connected robot owes an answer, and while this program is stopped.

        Limits of answers are counted by it: `timing.patience` limits the silence of a robot.
        """
        counted, since, most = self._answering
        return counted if since is None else counted + min(time.monotonic() - since, most)

    def add_listener(self, listener: Listener, silence: bool = False) -> None:
        """Call a function with the new state at each later change, from a thread of this connection.

        Listeners are called one after the other, in the order in which they were added. They may make remote
        calls; what they raise is logged. `silence`: call it also when `silent` begins or ends.
        """
        self._listeners.add(listener, silence)

    def remove_listener(self, listener: Listener) -> None:
        """Remove a listener; one that was never added is no error."""
        self._listeners.remove(listener)

    def in_background(self, job: Callable[[], None]) -> None:
        """Do a job in the thread of the listeners, after the state changes that are still in its queue."""
        self._listeners.in_background(job)

    def wait_connected(self, timeout: Optional[float] = None) -> bool:
        """Wait for the robot.

        `timeout`: limit in s; None waits until there is a connection or it is closed. Returns whether it is connected.
        """
        with self._condition:
            self._condition.wait_for(lambda: self._state in (State.CONNECTED, State.CLOSED), timeout)
            return self._state is State.CONNECTED

    def connect(self, limit: float) -> None:
        """Wait until the robot is there, or until an attempt has failed from now on.

        `limit`: longest wait, in s. Raises RobotUnreachable if it is not there.
        """
        with self._condition:
            failed_before = self._failed_attempts

            def decided() -> bool:
                waiting = self._state in (State.CONNECTING, State.LOST)
                return not waiting or self._failed_attempts > failed_before

            if not self._condition.wait_for(decided, limit):
                reason = f"no answer within {limit:g} s"
                raise RobotUnreachable(self.host, self.port, reason, connect_reason("timed out")[1])
            if self._state is State.CONNECTED:
                return
            if self.generation == 0 and self._state is State.CONNECTING:
                raise RobotUnreachable(self.host, self.port, self.last_error, self._check)
        raise self.unreachable()

    def unreachable(self) -> RobotUnreachable:
        """The error of a call that cannot be sent now: since when, why, and what is being done about it."""
        with self._condition:
            state, seconds, cause = self._state, time.monotonic() - self._since, self.last_error
            attempts, check = self._failed_attempts, self._check
        if state is State.CLOSED:
            return RobotUnreachable(self.host, self.port, "this program has closed the connection")
        if state is State.LOST:
            reason = f"connection lost {seconds:.1f} s ago ({cause}); reconnecting in the background"
            return RobotUnreachable(self.host, self.port, reason)
        if state is State.CONNECTED:  # the session broke a moment ago, the watching thread is about to see it
            return RobotUnreachable(self.host, self.port, "the connection has just broken; reconnecting")
        reason = f"not reached for {seconds:.1f} s, {attempts} failed attempts"
        reason += f" ({cause})" if cause else ""
        return RobotUnreachable(self.host, self.port, f"{reason}; trying on in the background", check)

    def service(self, name: str) -> Any:
        """The remote object of a module, in the present session.

        Raises RobotUnreachable if there is no session, UnknownModule if the robot has no module of that name.
        """
        live = self.live
        if live is None:
            raise self.unreachable()
        found = live.services.get(name)
        if found is None:
            with live.lookups[name]:  # of two threads that ask at once, libqi leaves one without an answer now and then
                found = live.services.get(name)
                if found is None:
                    found = live.services[name] = find_module(self, live, name)
                    self.used_modules.add(name)
        return found

    def forget_service(self, name: str) -> None:
        """Look a module up afresh the next time, because its remote object has gone stale."""
        live = self.live
        if live is not None:
            live.services.pop(name, None)

    def note_subscription(self, method: str, arguments: Tuple[Any, ...]) -> None:
        """Remember a call of ALMemory that has begun or ended an event subscription."""
        self.subscriptions.note(method, arguments)

    def answered(self, future: Any, limit: float) -> bool:
        """Wait for a future of libqi while there is a session.

        `limit`: in s of `answering_time`. Returns whether it is finished.
        """
        end = self.answering_time() + limit
        while future.wait(SLICE_MS) == RUNNING:
            if self.live is None or self.answering_time() >= end:
                return False
        return True

    def module_names(self) -> List[str]:
        """Names of all modules the robot has. Raises RobotUnreachable if there is no session."""
        live = self.live
        if live is None:
            raise self.unreachable()
        return module_names(self, live)

    def close(self) -> None:
        """End the connection for good. What was posted has reached the robot; calls under way fail."""
        with self._condition:
            if self._closing.is_set():
                return
            self._closing.set()
            live, opening = self.live, self._opening
        for close in tuple(self.closers):
            close()
        self.tasks.abandon()
        if live is not None:
            # Requests leave in order, so an answered one proves that posts and cancellations have arrived.
            live.heartbeat(_async=True).wait(int(1000.0 * FLUSH_LIMIT))
            live.broken.set()
            live.session.close()  # what the watching thread waits for fails, also when the robot is silent
        if opening is not None:
            opening.close()
        if threading.current_thread() is not self._watcher:
            self._watcher.join(EXIT_LIMIT)
        self._listeners.close()
        self.presence.wait_until_empty(EXIT_LIMIT)

    # From here on the watching thread.

    def _run(self) -> None:
        delay = self.timing.first_delay
        while not self._closing.is_set():
            try:
                live = self._open()
            except Exception as error:  # whatever it is, this thread is the only one that can bring it back
                self._note_failed_attempt(error)
                if not self._closing.wait(delay):
                    self._complain_once(error)
                delay = min(2.0 * delay, self.timing.longest_delay)
                continue
            delay = self.timing.first_delay
            self._enter(live)
            reason = self._watch(live)
            self._leave(live, reason)
        self._change(State.CLOSED)

    def _complain_once(self, error: Exception) -> None:
        """Warn of a robot that has never been reached; one that starts together with this program may need a while."""
        late = time.monotonic() - self._since >= self.timing.patience
        if late and self.generation == 0 and not self._complained:
            self._complained = True
            logger.warning("%s; trying on in the background", str(error).rstrip("."))

    def _open(self) -> Live:
        try:
            return open_live(self.host, self.port, self.timing.patience, self._announce)
        finally:
            with self._condition:
                self._opening = None

    def _announce(self, live: Live) -> None:
        """Let `close` break an attempt off; if it has been called already, do so here."""
        with self._condition:
            self._opening = live
            if self._closing.is_set():
                raise RobotUnreachable(self.host, self.port, "this program has closed the connection")

    def _enter(self, live: Live) -> None:
        was_lost, seconds = self._state is State.LOST, time.monotonic() - self._since
        if was_lost:
            logger.warning("connection to NAOqi at %s is back after %.1f s", self.address, seconds)
        else:
            logger.debug("connected to NAOqi at %s", self.address)
        live.connected_at = self.answering_time()
        self._change(State.CONNECTED, live)

    def _watch(self, live: Live) -> str:
        """Exchange heartbeats until the session ends; return why it did."""
        while True:
            sent = time.monotonic()
            self._answering = (self.answering_time(), None, 0.0)
            future = live.heartbeat(_async=True)
            if not self._answered(future):
                return f"silent for {self.timing.patience:g} s"
            if future.hasError():
                return future.error().rstrip(".").lower()
            answered = time.monotonic()
            self.latency = answered - sent
            self._answering = (self._answering[0], answered, 2.0 * self.timing.heartbeat_period)
            self._note_silence(None)
            if live.start_watch is None and self.answering_time() < live.connected_at + BOOT_LIMIT:
                watch_starts(live, self.timing.silence)
            if self._closing.is_set() or live.broken.wait(self.timing.heartbeat_period):
                return "NAOqi has started again" if live.has_restarted else "closed by the robot"

    def _answered(self, future: Any) -> bool:
        """Wait for the answer to a heartbeat, and report silence; False if the patience is over.

        Parts are counted, and not the clock read: a program that was itself stopped for a while finds the time over and
        the answer waiting, and needs only a moment to read it.
        """
        sent, waited, part = time.monotonic(), 0.0, self.timing.heartbeat_period
        while future.wait(int(1000.0 * part)) == RUNNING:
            waited += part
            if waited >= self.timing.patience or self._closing.is_set():
                return False
            if waited >= self.timing.silence:
                self._note_silence(sent)
        return True

    def _note_silence(self, since: Optional[float]) -> None:
        """Report that the robot is silent since a time, or (None) that it answers; only changes are reported."""
        before = self._silent_since
        if (since is None) == (before is None):
            return
        with self._condition:
            self._silent_since = since
            self._listeners.notify(self._state, silence=True)
        if before is None:
            logger.warning(
                "NAOqi at %s has not answered for %.1f s: calls wait for it, up to %g s",
                self.address,
                self.silent,
                self.timing.patience,
            )
        else:
            logger.warning("NAOqi at %s answers again, after %.1f s", self.address, time.monotonic() - before)

    def _leave(self, live: Live, reason: str) -> None:
        self.latency = self._silent_since = None
        self._answering = (self.answering_time(), time.monotonic(), math.inf)
        if self._closing.is_set():
            self.live = None
        else:
            self.last_error = reason
            self._change(State.LOST)
        live.close()  # makes the calls under way fail, also when the robot is silent
        if not self._closing.is_set():
            logger.warning("connection to NAOqi at %s lost (%s); reconnecting", self.address, reason)

    def _note_failed_attempt(self, error: Exception) -> None:
        if self._closing.is_set():
            return
        if not isinstance(error, RobotUnreachable):
            logger.error("an attempt to connect to %s failed in a new way", self.address, exc_info=error)
            error = RobotUnreachable(self.host, self.port, str(error))
        with self._condition:
            self.last_error, self._check = error.reason, error.check
            self._failed_attempts += 1
            self._condition.notify_all()

    def _change(self, state: State, live: Optional[Live] = None) -> None:
        with self._condition:
            self.live = live
            self._state = state
            self._since = time.monotonic()
            self._failed_attempts = 0
            self.generation += live is not None
            self._condition.notify_all()
            self._listeners.notify(state)  # with the lock: a thread that reads a state is notified of later ones only


def module_names(connection: Connection, live: Live) -> List[str]:
    """Names of all modules of the robot. Raises RobotUnreachable if it does not answer."""
    future = live.session.services(_async=True)
    if not connection.answered(future, ANSWER_LIMIT) or future.hasError():
        raise connection.unreachable()
    return [each["name"] for each in future.value()]


def find_module(connection: Connection, live: Live, name: str) -> Any:
    """The remote object of a module.

    Raises RobotUnreachable if the connection does not answer, UnknownModule if the robot has no module of that name,
    NaoError if the module exists but cannot be called.
    """
    end, delay = connection.answering_time() + READY_LIMIT, 0.005
    while True:
        future = live.session.service(name, _async=True)
        if not connection.answered(future, ANSWER_LIMIT):
            if live is not connection.live:
                raise connection.unreachable()
            reason = f"no answer to the question where module {name} is"
            raise RobotUnreachable(connection.host, connection.port, reason)
        if not future.hasError():
            return future.value()
        text = future.error().strip()
        if is_unknown_service(text):
            names = module_names(connection, live)
            # It may also have appeared between the two questions.
            expected = name in names or name in connection.used_modules
            starting = expected or not any(each.startswith("AL") for each in names)
            limit = FIRST_MODULE_LIMIT if starting else START_LIMIT
            if connection.answering_time() < live.connected_at + limit and not live.broken.wait(delay):
                continue
            raise unknown_module(name, connection.host, connection.port, names)
        if live is not connection.live or not live.session.isConnected():
            raise connection.unreachable()
        # The module has just been registered, or is being unregistered.
        if connection.answering_time() >= end or live.broken.wait(delay):
            raise NaoError(f"NAOqi at {connection.address} gave no access to module {name}: {text}")
        delay *= 2.0


class Registry:
    """Connections by address."""

    def __init__(self) -> None:
        self._lock = threading.Lock()  # guards both tables
        self._connections: Dict[Tuple[str, int], Connection] = {}
        self._wanted: Dict[Connection, int] = {}
        # From the import on: what a program registers afterwards is called before, and reaches the robot.
        atexit.register(self._end)

    def get(self, host: str, port: int, wait: bool, limit: Optional[float], timing: Optional[Timing]) -> Connection:
        """The connection to an address; see `connection`."""
        with self._lock:
            found: Optional[Connection] = self._connections.get((host, port))
            if found is None or found.state is State.CLOSED:
                self._wanted.pop(found, None)
                found = self._connections[host, port] = Connection(host, port, timing or DEFAULT_TIMING)
            elif timing is not None:
                found.timing = timing
            self._wanted[found] = self._wanted.get(found, 0) + 1
        if wait:
            try:
                found.connect(found.timing.patience if limit is None else limit)
            except RobotUnreachable:
                self._give_up(found)
                raise
        return found

    def close_all(self) -> None:
        """Close every connection."""
        with self._lock:
            connections = list(self._connections.values())
            self._connections.clear()
            self._wanted.clear()
        for each in connections:
            each.close()

    def _end(self) -> None:
        """Close every connection at the end of the program: libqi's threads must not meet one that is taken down."""
        if self._connections:
            _end_objects_of_the_program()
        self.close_all()
        wait_until_idle(IDLE_LIMIT)

    def _give_up(self, connection: Connection) -> None:
        """Close a connection that was never made and that no other caller waits for."""
        with self._lock:
            self._wanted[connection] = self._wanted.get(connection, 1) - 1
            unwanted = self._wanted[connection] <= 0 and connection.generation == 0
            if unwanted:
                del self._wanted[connection]
                self._connections.pop((connection.host, connection.port), None)
        if unwanted:
            connection.close()


def _end_objects_of_the_program() -> None:
    """Let go of the objects that the program keeps in its own module, as Python is about to do.

    What their `__del__` sends reaches the robot: Python calls it when the connections have closed.
    """
    main = vars(sys.modules["__main__"])
    for name in [name for name, value in main.items() if _is_of_the_program(type(value))]:
        main[name] = None
    gc.collect()


def _is_of_the_program(kind: type) -> bool:
    return kind.__module__ == "__main__" or isinstance(getattr(kind, "__del__", None), FunctionType)


_registry = Registry()


def connection(
    ip: str,
    port: int = DEFAULT_PORT,
    *,
    wait: bool = True,
    connect_timeout: Optional[float] = None,
    timing: Optional[Timing] = None,
) -> Connection:
    """The connection to the NAOqi at an address, opened by the first caller.

    Raises BadArguments if this is no address, RobotUnreachable if the robot is not there (only with `wait`).

    Args:
        ip: Name or IPv4 address of the robot.
        port: TCP port of NAOqi.
        wait: Whether to wait until it stands. Without, it is opened in the background, again and again until
            the robot is there; calls made before then fail at once.
        connect_timeout: Limit of the wait, in s; None: the patience of the connection.
        timing: How patient the connection is, for all who share it; the last that was given counts.
    """
    reason = ""
    if not isinstance(ip, str) or not ip.strip():
        reason = "the first must be the name or IPv4 address of the robot"
    elif isinstance(port, bool) or not isinstance(port, int) or not 0 < port < 65536:
        reason = "the port must be a number from 1 to 65535"
    if reason:
        raise BadArguments("naoqi", "connection", (ip, port), reason=reason)
    return _registry.get(ip.strip(), port, wait, connect_timeout, timing)


def close_all() -> None:
    """Close every connection of this process, as happens by itself at its end."""
    _registry.close_all()
