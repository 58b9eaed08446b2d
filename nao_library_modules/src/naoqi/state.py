"""The state of a connection, its listeners, and the event subscriptions to renew after a loss.

Callbacks run in a `Worker`, not in libqi's own threads: there are only a few of them, and they also carry the answers
that a callback may be waiting for.
"""

from __future__ import annotations

import enum
import logging
import queue
import threading
from typing import Any, Callable, Collection, Dict, Optional, Sequence, Set, Tuple

from .calls import ENDED_BY, RemoteMethod, RemoteModule, Transport
from .errors import NaoError, RobotUnreachable, UnknownModule
from .limits import ANSWER_LIMIT, EXIT_LIMIT
from .session import MEMORY, Presence

logger = logging.getLogger("naoqi")


class Worker:
    """A queue of jobs and the thread that works it off; the thread starts with the first job."""

    def __init__(self, name: str, presence: Optional[Presence] = None) -> None:
        """Make an idle worker.

        `name`: of its thread, for logs and debuggers. `presence`: of the connection for which its jobs use libqi.
        """
        self.name = name
        self._presence = presence or Presence()
        self._jobs: queue.SimpleQueue[Optional[Tuple[object, Callable[[], None]]]] = queue.SimpleQueue()
        self._lock = threading.Lock()  # guards the two below
        self._thread: Optional[threading.Thread] = None
        self._closed = False

    def submit(self, job: Callable[[], None]) -> bool:
        """Queue a job behind those that wait already.

        `job`: called without arguments in the thread of the worker; what it raises is logged. Returns whether it was
        taken; False after `close`.
        """
        with self._lock:
            if self._closed:
                return False
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name=self.name, daemon=True)
                self._thread.start()
            entry = object()
            self._presence.enter(entry, self._thread.ident)
            self._jobs.put((entry, job))
        return True

    def close(self) -> None:
        """Take no more jobs, and end the thread after those it has."""
        with self._lock:
            self._closed = True
        self._jobs.put(None)

    def join(self, timeout: float) -> None:
        """Wait up to `timeout` s for the end of the thread; a job may close its own worker, then it does not wait."""
        with self._lock:
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join(max(0.0, timeout))

    def _work(self) -> None:
        while True:
            item = self._jobs.get()
            if item is None:
                return
            entry, job = item
            try:
                job()
            except BaseException:  # a callback may call sys.exit(): the thread serves others too
                logger.exception("a callback in %s failed", self.name)
            # While this thread waits, it must hold nothing of libqi's: the end of the program would delete it
            # with the frame of this thread, too late for libqi.
            item = job = None
            self._presence.leave(entry)


class State(str, enum.Enum):
    """The state of a connection; equal to its text, so `connection.state == "connected"` works.

    A connected robot may be silent for a while: see `Connection.silent`.
    """

    CONNECTING = "connecting"
    CONNECTED = "connected"
    LOST = "lost"
    CLOSED = "closed"

    def __str__(self) -> str:
        return self.value


Listener = Callable[[State], None]


class Listeners:
    """Functions that are called with each new state, one after the other, in one thread."""

    def __init__(self, name: str) -> None:
        """Make an empty list. `name`: of the thread."""
        self._lock = threading.Lock()  # guards the list; not held during calls
        self._listeners: Dict[
            Listener, bool
        ] = {}  # whether it is notified of silence as well; in the order of their calls
        self._worker = Worker(name)

    def add(self, listener: Listener, silence: bool) -> None:
        """Add a function, called after those added before; when silence starts or ends only with `silence`."""
        with self._lock:
            self._listeners[listener] = silence

    def remove(self, listener: Listener) -> None:
        """Remove a function; one that was never added is no error."""
        with self._lock:
            self._listeners.pop(listener, None)

    def notify(self, state: State, silence: bool = False) -> None:
        """Call the present listeners with a state, without waiting for it. `silence`: it started or ended."""
        with self._lock:
            listeners = tuple(each for each, of_silence in self._listeners.items() if of_silence or not silence)
        self._worker.submit(lambda: self._call(listeners, state))

    def in_background(self, job: Callable[[], None]) -> None:
        """Do a job in the same thread, after the notifications queued before."""
        self._worker.submit(job)

    def close(self) -> None:
        """Notify no more; wait a moment for the notifications queued before."""
        self._worker.close()
        self._worker.join(EXIT_LIMIT)

    def _call(self, listeners: Sequence[Listener], state: State) -> None:
        for listener in listeners:
            with self._lock:
                removed = listener not in self._listeners
            try:
                if not removed:
                    listener(state)
            except Exception:
                logger.exception("listener %r of a connection failed at state %s", listener, state)


Key = Tuple[str, str, str]
"""Subscribing method, event, module."""


class EventSubscriptions:
    """The event subscriptions of this process over one connection: a robot that comes back has forgotten them.

    Those of the modules of this process are renewed by the broker that serves the module, after it has
    registered it; all others as soon as the robot is back.
    """

    def __init__(self, connection: Transport) -> None:
        self._connection = connection
        self._memory = RemoteModule(MEMORY, connection, ANSWER_LIMIT)
        self._lock = threading.Lock()  # guards the table
        self._arguments: Dict[Key, Tuple[Any, ...]] = {}
        self._owned: Set[str] = set()
        self._worker = Worker(f"naoqi subscriptions {connection.address}", connection.presence)

    def __len__(self) -> int:
        return len(self._arguments)

    def note(self, method: str, arguments: Tuple[Any, ...]) -> None:
        """Record a call that succeeded.

        `method`: one of `SUBSCRIBING`. `arguments`: event, module, and for a subscription what else it had.
        """
        event, module = arguments[:2]
        with self._lock:
            if method in ENDED_BY:
                self._arguments.pop((ENDED_BY[method], event, module), None)
                return
            self._arguments[method, event, module] = arguments

    def own(self, module: str) -> None:
        """Leave the subscriptions of this module to the broker that serves it."""
        with self._lock:
            self._owned.add(module)

    def forget_module(self, module: str) -> None:
        """Drop the subscriptions of a module that is served no more."""
        with self._lock:
            self._arguments = {key: value for key, value in self._arguments.items() if key[2] != module}
            self._owned.discard(module)

    def renew(self, modules: Collection[str]) -> None:
        """Renew the subscriptions of some modules; a failure is logged, and tried again after the next loss."""
        with self._lock:
            entries = [item for item in self._arguments.items() if item[0][2] in modules]
        if not entries or not self._memory_is_there():
            return
        done = 0
        for (method, event, module), arguments in entries:
            try:
                RemoteMethod(self._memory, method)(*arguments)
                done += 1
            except NaoError as error:
                logger.error("event %s is not subscribed again for module %s: %s", event, module, error)
        if done:
            logger.warning("NAOqi at %s: %d event subscriptions made again", self._connection.address, done)

    def on_state(self, state: State) -> None:
        """Renew them when the robot is back; a listener of the connection."""
        if state == "closed":
            self._worker.close()
        elif state == "connected" and self._connection.generation > 1:
            with self._lock:
                foreign = {key[2] for key in self._arguments} - self._owned
            if foreign:
                self._worker.submit(lambda: self.renew(foreign))

    def _memory_is_there(self) -> bool:
        """Wait for ALMemory: a robot that boots can be reached long before it has all its modules.

        Returns False if the connection is lost before that; then the next one brings a new attempt.
        """
        delay = 0.1
        while True:
            live = self._connection.live
            try:
                self._memory.service()
                return True
            except UnknownModule:
                if live is None or live.broken.wait(delay):
                    return False
                delay = min(2.0 * delay, 2.0)
            except RobotUnreachable:
                return False
