"""Programs that this one starts, watches and ends, and its own end. No ROS."""

from __future__ import annotations

import enum
import logging
import os
import signal
import subprocess
import sys
import threading
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Tuple

from naoqi.errors import NaoError

from .errors import did_you_mean

log = logging.getLogger(__name__)

CLOSE_LIMIT = 4.0
"""s that all steps together may take."""
EXIT_LIMIT = 5.0
"""s after which the process ends in any case."""

Step = Callable[[], object]


def close_all(*steps: Step, limit: float = CLOSE_LIMIT) -> None:
    """Make steps one after the other; one that raises is logged, one that hangs is left to itself.

    All may take `limit` s together; each may take half of the time that is left, then the next begins.
    """
    deadline = time.monotonic() + limit
    begun = [_begin(step, deadline) for step in steps]
    for step, thread in zip(steps, begun):
        thread.join(max(0.0, deadline - time.monotonic()))
        if thread.is_alive():
            log.error("%s has not ended within %g s and is left", _name(step), limit)


def _begin(step: Step, deadline: float) -> threading.Thread:
    thread = threading.Thread(target=_guarded, args=(step,), name=_name(step), daemon=True)
    thread.start()
    thread.join(max(0.0, deadline - time.monotonic()) / 2.0)
    return thread


def _guarded(step: Step) -> None:
    try:
        step()
    except Exception:
        log.exception("%s failed, at the end of the program", _name(step))


def _name(step: Step) -> str:
    return getattr(step, "__qualname__", repr(step))


def exit_in_time(limit: float = EXIT_LIMIT) -> threading.Timer:
    """End the process after `limit` s, even if threads still wait. Returns the timer, which can be cancelled."""

    def end() -> None:
        print(f"the end took longer than {limit:g} s: something hangs, and is cut off", file=sys.stderr, flush=True)
        os._exit(1)

    timer = threading.Timer(limit, end)
    timer.name, timer.daemon = "limit of the end", True
    timer.start()
    return timer


@dataclass(frozen=True)
class ProcessId:
    """A process; its start, in clock ticks since boot, distinguishes it from a later one with the same number."""

    pid: int
    started: int


def _stat(pid: int) -> list[str]:
    """Fields of /proc/<pid>/stat after the name (which may hold spaces); empty when the process is gone."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return []
    return text[text.rindex(")") + 2 :].split()


def identify(pid: int) -> ProcessId | None:
    """The process with that number, None if there is none or it has ended."""
    fields = _stat(pid)
    if not fields or fields[0] == "Z":
        return None
    return ProcessId(pid, int(fields[19]))


def descendants(pid: int) -> list[ProcessId]:
    """All processes below `pid` that are alive, parents before their children."""
    children: dict[int, list[int]] = {}
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            fields = _stat(int(entry))
            if fields:
                children.setdefault(int(fields[1]), []).append(int(entry))
    found = []
    pending = [pid]
    while pending:
        for child in children.get(pending.pop(0), ()):
            pending.append(child)
            identity = identify(child)
            if identity is not None:
                found.append(identity)
    return found


def kill_survivors(processes: list[ProcessId]) -> list[int]:
    """Kill those of the processes that are still alive; their numbers."""
    killed = []
    for process in processes:
        if identify(process.pid) == process:
            try:
                os.kill(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                continue
            killed.append(process.pid)
    return killed


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


LaunchPath = Tuple[str, str]


class BadLaunchPath(NaoError):
    """A launch path `(package, launchfile)` names no launch file that can be read."""

    def __init__(self, launchpath: object, problem: str) -> None:
        super().__init__(f"launchpath {launchpath!r}: {problem}: it is (package, launchfile)")
        self.launchpath = launchpath


def find_launch_file(launchpath: LaunchPath) -> Path:
    """Path of a launch file, found as roslaunch finds it. Raises BadLaunchPath if it is not there."""
    from roslaunch.core import RLException
    from roslaunch.rlutil import resolve_launch_arguments

    try:
        package, launchfile = launchpath
        return Path(resolve_launch_arguments([package, launchfile])[0])
    except (TypeError, ValueError):
        raise BadLaunchPath(launchpath, "not a pair of names") from None
    except RLException as error:
        raise BadLaunchPath(launchpath, _missing(package, launchfile) or str(error)) from error


def _missing(package: str, launchfile: str) -> str:
    """The problem with the name that is not found, with names that come close; empty if both are."""
    import roslib.packages
    import rospkg

    packages = rospkg.RosPack()
    try:
        folder = packages.get_path(package)
    except rospkg.ResourceNotFound:
        return f"there is no package {package!r}{did_you_mean(package, packages.list())}"
    if roslib.packages.find_resource(package, launchfile):
        return ""
    files = [path.name for path in Path(folder).rglob("*.launch")]
    return f"the package {package} has no {launchfile!r}{did_you_mean(launchfile, files)}"


def declared_arguments(launch_file: Path) -> set[str]:
    """Names of the arguments that a launch file takes: those it declares without a fixed value.

    Raises BadLaunchPath if the file is no XML.
    """
    try:
        root = ElementTree.parse(launch_file).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise BadLaunchPath(str(launch_file), str(error)) from error
    return {arg.get("name", "") for arg in root.findall("arg") if arg.get("value") is None}


def launched_nodes(launchpath: LaunchPath, ip: str, port: int, namespace: str) -> frozenset[str]:
    """Full names of the nodes that a launch file starts for a robot in a namespace.

    Raises BadLaunchPath if it cannot be read.
    """
    from rosgraph.names import get_ros_namespace, ns_join
    from roslaunch.config import load_config_default
    from roslaunch.core import RLException

    path = find_launch_file(launchpath)
    arguments = launch_arguments(declared_arguments(path), ip, port)
    try:
        config = load_config_default([(str(path), arguments)], None, verbose=False)
    except RLException as error:
        raise BadLaunchPath(launchpath, str(error)) from error
    ours = get_ros_namespace(argv=[])  # what the loader took relative names to be in
    names = (ns_join(node.namespace, node.name) for node in config.nodes)
    return frozenset(ns_join(namespace, name[len(ours) :]) if name.startswith(ours) else name for name in names)


def launch_arguments(declared: Collection[str], ip: str, port: int) -> list[str]:
    """Those of `nao_ip` and `nao_port` that a launch file declares, set for a robot."""
    robot = {"nao_ip": ip, "nao_port": str(port)}
    return [f"{name}:={value}" for name, value in robot.items() if name in declared]


def launch_supervisor(launchpath: LaunchPath, ip: str, port: int, namespace: str) -> Supervisor:
    """A supervisor for a launch file, not started; its nodes start in the namespace.

    Raises BadLaunchPath if there is no such file.
    """
    declared = declared_arguments(find_launch_file(launchpath))
    return Supervisor(
        ["roslaunch", *launchpath, *launch_arguments(declared, ip, port)],
        name=" ".join(("roslaunch", *launchpath)),
        environment={"ROS_NAMESPACE": namespace},
    )
