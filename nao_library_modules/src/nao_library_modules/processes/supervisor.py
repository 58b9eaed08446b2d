"""A program that is kept running: started again when it dies, stopped with all it started. No ROS."""

from __future__ import annotations

import enum
import logging
import os
import signal
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .process_tree import descendants, kill_survivors

log = logging.getLogger(__name__)


WITH_ITS_PARENT = ("setpriv", "--pdeathsig", "TERM")
"""Before a command: the system ends the program when the thread that started it has ended, as in a process that was
killed. roslaunch ends its nodes then."""


class State(enum.Enum):
    """What a supervised program does at present."""

    STOPPED = "stopped"
    RUNNING = "running"
    WAITING = "waiting to be started again"


@dataclass(frozen=True)
class Timing:
    """Delays of a supervisor, in s.

    Attributes:
        first_delay: Before the first restart; doubles with each one.
        longest_delay: Limit of that.
        settled: A program that ran this long has started well: its next restart comes after the first delay.
        interrupt: Given to it to end after SIGINT. roslaunch passes that on to its nodes.
        terminate: Given to it to end after SIGTERM.
        kill: Given to it to disappear after SIGKILL.
    """

    first_delay: float = 1.0
    longest_delay: float = 30.0
    settled: float = 60.0
    interrupt: float = 2.5
    terminate: float = 0.5
    kill: float = 0.5


@dataclass(frozen=True)
class Status:
    """What there is to say about a supervised program.

    Attributes:
        state: What it does.
        pid: Number of the process, None when none is running.
        restarts: How often it was started again.
        last_end: How it ended last, empty if it never did.
    """

    state: State
    pid: int | None
    restarts: int
    last_end: str


@dataclass(frozen=True)
class _Running:
    """A process that runs.

    Attributes:
        pid: Its number, which is that of its process group as well.
        ended: Set by the watching thread when it has ended.
    """

    pid: int
    ended: threading.Event


class Supervisor:
    """Runs a program in a process group of its own, watched by a thread of its own.

    The lock guards `_running` and `_status`. `stop` may be called from any thread, even from a signal
    handler of the main thread: it takes the lock only for moments in which nothing is waited for.
    """

    def __init__(
        self,
        command: Sequence[str],
        name: str,
        environment: Mapping[str, str] | None = None,
        timing: Timing | None = None,
    ) -> None:
        """Prepare; nothing is started.

        Args:
            command: Program and arguments; no shell sees them.
            name: What the log calls it.
            environment: Variables to add to those of this process.
            timing: Delays.
        """
        self._command = list(command)
        self._name = name
        self._environment = {**os.environ, **(environment or {})}
        self._timing = timing or Timing()
        self._lock = threading.RLock()
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None
        self._running: _Running | None = None
        self._status = Status(State.STOPPED, None, 0, "")

    @property
    def status(self) -> Status:
        """What the program does at present."""
        with self._lock:
            return self._status

    def start(self) -> None:
        """Start the program; no effect when it is being kept running already."""
        with self._lock:
            if self._thread is not None and self._thread.is_alive():
                return
            self._stopping = threading.Event()
            self._thread = threading.Thread(
                target=self._keep_running,
                args=(self._stopping,),
                name=f"supervisor of {self._name}",
                daemon=True,
            )
            self._thread.start()

    def stop(self) -> None:
        """End the program and all that it started; returns when they are gone, or the limits are reached."""
        with self._lock:
            thread = self._thread
            self._stopping.set()
            running = self._running
        if running is not None:
            self._end(running)
        if thread is not None and thread is not threading.current_thread():
            thread.join(self._timing.kill)

    def _keep_running(self, stopping: threading.Event) -> None:
        delay = self._timing.first_delay
        while True:
            began = time.monotonic()
            end = self._run_once(stopping)
            if stopping.is_set():
                log.info("%s %s", self._name, end)
                self._note(State.STOPPED, None, last_end=end)
                return
            if time.monotonic() - began >= self._timing.settled:
                delay = self._timing.first_delay
            log.error("%s %s; it is started again in %g s", self._name, end, delay)
            self._note(State.WAITING, None, last_end=end)
            if stopping.wait(delay):
                self._note(State.STOPPED, None)
                return
            delay = min(2.0 * delay, self._timing.longest_delay)
            with self._lock:
                self._status = Status(State.WAITING, None, self._status.restarts + 1, end)

    def _run_once(self, stopping: threading.Event) -> str:
        with self._lock:
            if stopping.is_set():
                return "was stopped before it began"
            try:
                # A session of its own: Ctrl-C in the terminal reaches this process, which then ends the
                # program.
                process = subprocess.Popen(
                    [*WITH_ITS_PARENT, *self._command], env=self._environment, start_new_session=True
                )
            except OSError as error:
                return f"cannot be started: {error}"
            running = self._running = _Running(process.pid, threading.Event())
        log.info("%s started (process %d)", self._name, process.pid)
        self._note(State.RUNNING, process.pid)
        code = process.wait()
        with self._lock:
            self._running = None
        running.ended.set()
        if stopping.is_set():
            end = "was stopped"
        elif code < 0:
            end = f"was ended by {signal.Signals(-code).name}"
        else:
            end = f"ended by itself with exit status {code}"
        return end

    def _note(self, state: State, pid: int | None, last_end: str | None = None) -> None:
        with self._lock:
            old = self._status
            self._status = Status(state, pid, old.restarts, old.last_end if last_end is None else last_end)

    def _end(self, running: _Running) -> None:
        below = descendants(running.pid)
        for number, limit in (
            (signal.SIGINT, self._timing.interrupt),
            (signal.SIGTERM, self._timing.terminate),
            (signal.SIGKILL, self._timing.kill),
        ):
            if running.ended.is_set():
                break
            try:
                os.killpg(running.pid, number)
            except ProcessLookupError:
                break
            if not running.ended.wait(limit):
                log.warning("%s did not end within %g s of %s", self._name, limit, number.name)
        killed = kill_survivors(below)
        if killed:
            log.warning("%s left processes behind, killed: %s", self._name, killed)
