"""A program that is kept running: started again when it dies, stopped with all its processes. No ROS."""

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


class SupervisorState(enum.Enum):
    STOPPED = "stopped"
    RUNNING = "running"
    WAITING = "waiting to be started again"


@dataclass(frozen=True)
class RestartTiming:
    """Delays of a supervisor, in s."""

    first_delay: float = 1.0  # before the first restart; doubles with each one
    longest_delay: float = 30.0
    settled: float = 60.0  # a program that ran this long has started well: its next restart is after the first delay
    interrupt: float = 2.5  # to end after SIGINT, which roslaunch passes on to its nodes
    terminate: float = 0.5  # to end after SIGTERM
    kill: float = 0.5  # to disappear after SIGKILL


@dataclass(frozen=True)
class Status:
    state: SupervisorState
    pid: int | None  # None when no process is running
    restarts: int
    last_end: str  # how it ended last, empty if it never did


@dataclass(frozen=True)
class _Running:
    """A process that runs; `ended` is set by the watching thread."""

    pid: int  # of its process group as well
    ended: threading.Event


class Supervisor:
    """Runs a program in a process group of its own, watched by a thread of its own.

    The lock guards `_running` and `_status`. `stop` may be called from any thread, even from a signal
    handler of the main thread: it takes the lock only for moments in which nothing is waited for.

    Args:
        command: Program and arguments; no shell is used.
        name: Name for the log.
        environment: Variables to add to those of this process.
        timing: Delays.
    """

    def __init__(
        self,
        command: Sequence[str],
        name: str,
        environment: Mapping[str, str] | None = None,
        timing: RestartTiming | None = None,
    ) -> None:
        self._command = list(command)
        self._name = name
        self._environment = {**os.environ, **(environment or {})}
        self._timing = timing or RestartTiming()
        self._lock = threading.RLock()
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None
        self._running: _Running | None = None
        self._status = Status(SupervisorState.STOPPED, None, 0, "")

    @property
    def status(self) -> Status:
        with self._lock:
            return self._status

    def start(self) -> None:
        """Start the program; no effect when it is being kept running already."""
        with self._lock:
            if self._thread is not None and self._thread.is_alive():
                return
            self._stopping = threading.Event()
            self._thread = threading.Thread(
                target=self._keep_running, args=(self._stopping,), name=f"supervisor of {self._name}", daemon=True
            )
            self._thread.start()

    def stop(self) -> None:
        """End the program and all its processes; returns when they are gone, or the limits are reached."""
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
                self._note(SupervisorState.STOPPED, None, last_end=end)
                return
            if time.monotonic() - began >= self._timing.settled:
                delay = self._timing.first_delay
            log.error("%s %s; it is started again in %g s", self._name, end, delay)
            self._note(SupervisorState.WAITING, None, last_end=end)
            if stopping.wait(delay):
                self._note(SupervisorState.STOPPED, None)
                return
            delay = min(2.0 * delay, self._timing.longest_delay)
            with self._lock:
                self._status = Status(SupervisorState.WAITING, None, self._status.restarts + 1, end)

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
        self._note(SupervisorState.RUNNING, process.pid)
        code = process.wait()
        with self._lock:
            self._running = None
        running.ended.set()
        if stopping.is_set():
            return "was stopped"
        return f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended by itself with exit status {code}"

    def _note(self, state: SupervisorState, pid: int | None, last_end: str | None = None) -> None:
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
