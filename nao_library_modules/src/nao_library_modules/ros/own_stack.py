"""A ROS master, or a simulated robot with all its nodes, on ports of its own, for as long as a program needs it."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from naoqi.errors import NaoError

from ..core.processes import WITH_ITS_PARENT

if TYPE_CHECKING:
    from rosmaster.master import Master


START_LIMIT = 90.0
PERIOD = 0.05
COLOUR = re.compile(r"\x1b\[[\d;]*m")
LABELLED = re.compile(
    r"\[(?P<severity>[A-Z]+)\] \[(?P<node>/\S*)\]: (?P<text>.*)|\[roslaunch\] |\[[WIVD]\] [\d.]+ \d+ qi"
)
"""A line of a node's log, as LINES has it, of roslaunch, or of libqi below an error. All else has no label."""
LINES = "[${severity}] [${node}]: ${message}"
LONGEST = 300
"""Characters of last words."""
PORTS = ("/nao_sim/bound_port", "/nao1/nao_sim/bound_port")
"""Parameters of which one tells the port: of a robot that is alone, and of the first of several."""
PROGRAM = "nao_library_modules.ros.launch_program"
LIMITS = ((signal.SIGINT, 40.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 5.0))
"""Signals in turn, and s that roslaunch may take after each. It kills nodes that do not end themselves after 17 s; if
it were killed before, they would be left."""


class StackFailed(NaoError):
    """A stack did not come up, or a process of it has ended.

    `process`: name of the node whose process has ended; empty if it was none. `status`: its exit status, or minus the
    number of a signal.
    """

    def __init__(self, text: str, process: str = "", status: int | None = None) -> None:
        super().__init__(text)
        self.process = process
        self.status = status


class OwnStack:
    """Simulator, driver and action servers, launched on ports that the system gives to who listens on them.

    Args:
        log: File for the output of roslaunch and the nodes.
        arguments: Of the launch file, by name.
        launch: What roslaunch starts: package and launch file, or the path of one.
        master_uri: Of a ROS master that runs already; empty for one of its own.

    Raises:
        StackFailed: Its ROS master did not come up.
    """

    def __init__(
        self,
        log: Path,
        arguments: Mapping[str, str],
        launch: Sequence[str] = ("nao_library", "nao_sim.launch"),
        master_uri: str = "",
    ) -> None:
        self.log = log
        self.master_uri = master_uri
        self._port = 0
        self._news = threading.Condition()
        self._ended: StackFailed | None = None
        self._refused = ""
        if master_uri:
            self._forget_port()
        self._process, reports = _launch(log, [*launch, *_words(arguments)], master_uri)
        threading.Thread(target=self._read, args=(reports,), name="reports of a launch", daemon=True).start()
        self._wait(lambda: bool(self.master_uri), "the ROS master", START_LIMIT)

    @property
    def nao_port(self) -> int:
        """Port of the simulated robot's NAOqi, of the first of several; known after `wait_for_robot`."""
        if not self._port:
            raise StackFailed("the port of the robot is not known yet: wait_for_robot() comes first")
        return self._port

    @property
    def pid(self) -> int:
        return self._process.pid

    def alive(self) -> bool:
        return self._process.poll() is None

    def wait_for_robot(self, limit: float = START_LIMIT) -> None:
        """Wait up to `limit` s until the simulated robot answers: parameters are set then, and nodes come up.

        Raises:
            StackFailed: It does not, or a process of the stack has ended; the error has its last words.
        """
        self.wait_until(self._ask_port, "the simulated robot", limit)

    def wait_until(self, holds: Callable[[], bool], what: str, limit: float = START_LIMIT) -> None:
        """Wait up to `limit` s until `holds()`, which answers soon: for what no event tells, such as a server.

        Raises:
            StackFailed: It does not hold, or a process of the stack has ended; the error has its last words.
        """
        self._wait(holds, what, limit)

    def check(self) -> None:
        """Raise StackFailed if a process of the stack has ended with another exit status than 0 since its start."""
        with self._news:
            if self._ended is not None:
                raise self._ended

    def stop(self) -> None:
        for number, limit in LIMITS:
            if self.alive():
                self._process.send_signal(number)
                self._ended_within(limit)

    def __enter__(self) -> OwnStack:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _wait(self, holds: Callable[[], bool], what: str, limit: float) -> None:
        deadline = time.monotonic() + limit
        while not holds():
            with self._news:
                if self._ended is None:
                    self._news.wait(PERIOD)
                if self._ended is not None:
                    ended = self._ended
                    raise StackFailed(f"{what} does not come up: {ended}", ended.process, ended.status)
            if time.monotonic() > deadline:
                raise StackFailed(f"{what} does not come up: not there within {limit:g} s; all output is in {self.log}")

    def _read(self, reports: int) -> None:
        """Take what the launch reports, until it has ended."""
        with os.fdopen(reports, encoding="utf-8") as lines:
            for line in lines:
                self._take(json.loads(line))
        self._note(StackFailed(self._words_of_launch()))

    def _take(self, report: Mapping[str, object]) -> None:
        if "master" in report:
            with self._news:
                self.master_uri = str(report["master"])
                self._news.notify_all()
        elif "refused" in report:
            self._refused = str(report["refused"])
        elif "ending" in report:
            if fatal_words(self.log):  # else why is reported next, or nobody knows
                self._note(StackFailed(self._words_of_launch()))
        elif report["status"] != 0:
            name, status = str(report["ended"]), report["status"]
            words = last_words(self.log, name)
            text = f"{name} has ended with exit status {status}: {words}; all output is in {self.log}"
            self._note(StackFailed(text, name, status if isinstance(status, int) else None))

    def _note(self, ended: StackFailed) -> None:
        with self._news:
            self._ended = self._ended or ended  # the first one: others end because of it
            self._news.notify_all()

    def _words_of_launch(self) -> str:
        told = self._refused or fatal_words(self.log) or "without a word"
        return f"its launch ends: {told}; all output is in {self.log}"

    def _ask_port(self) -> bool:
        """Ask the master for the port that the simulator has told it."""
        import rosgraph

        master = rosgraph.Master("/own_stack", self.master_uri)
        for name in PORTS:
            try:
                self._port = self._port or int(master.getParam(name))
            except (rosgraph.MasterError, OSError):
                continue  # not set, or a master that has ended: its process tells
        return self._port != 0

    def _forget_port(self) -> None:
        """Of a former stack on this master."""
        import rosgraph

        for name in PORTS:
            try:
                rosgraph.Master("/own_stack", self.master_uri).deleteParam(name)
            except rosgraph.MasterError:
                continue  # it is not set

    def _ended_within(self, seconds: float) -> bool:
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return True


def _words(arguments: Mapping[str, str]) -> list[str]:
    return [f"{name}:={value}" for name, value in {"nao_port": "0", **arguments}.items()]


def _launch(log: Path, words: Sequence[str], master_uri: str) -> tuple[subprocess.Popen[bytes], int]:
    """Start the program that launches; it, and the descriptor of its reports."""
    environment = {name: value for name, value in os.environ.items() if name != "ROS_MASTER_URI"}
    environment.update({"ROS_MASTER_URI": master_uri} if master_uri else {}, ROSCONSOLE_FORMAT=LINES)
    reports, writes = os.pipe()
    # It gets Ctrl-C when this process is killed, and ends its nodes.
    command = ["setpriv", "--pdeathsig", "INT", sys.executable, "-m", PROGRAM, str(writes), *words]
    try:
        with log.open("wb") as output, _interruptible():
            process = subprocess.Popen(
                command,
                stdout=output,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                start_new_session=True,
                pass_fds=[writes],
                env=environment,
            )
    except BaseException:
        os.close(reports)
        raise
    finally:
        os.close(writes)
    return process, reports


def last_words(log: Path, node: str) -> str:
    """The last line of a node in the output of a stack, or the last one that no other program has labelled."""
    for line in reversed(_lines(log)):
        found = LABELLED.match(line)
        if found is None:
            return line[-LONGEST:]
        if found["node"] == node:
            return found["text"][-LONGEST:]
    return "it printed nothing"


def fatal_words(log: Path) -> str:
    """The first line with which a node has ended its launch; empty if none has."""
    for line in _lines(log):
        found = LABELLED.match(line)
        if found is not None and found["severity"] == "FATAL":
            return f"{found['node']}: {found['text']}"[-LONGEST:]
    return ""


def _lines(log: Path) -> list[str]:
    text = COLOUR.sub("", log.read_text(encoding="utf-8", errors="replace"))
    return [line for line in text.splitlines() if line.strip()]


@contextmanager
def _interruptible() -> Iterator[None]:
    """Programs that are started here can be ended by Ctrl-C, also where this thread blocks it, as in workers of Ray."""
    before = signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


LOOK_PERIOD = 0.1
"""s between two looks whether the master has been told to end."""


class MasterFailed(NaoError):
    """A ROS master did not come up."""


class OwnMaster:
    """A ROS master in a process of its own, which ends with this one. It answers from the start on.

    Attributes:
        uri: What nodes have in ROS_MASTER_URI.

    Args:
        log: File for its output.

    Raises:
        MasterFailed: It ended before it listened.
    """

    def __init__(self, log: Path) -> None:
        command = [*WITH_ITS_PARENT, sys.executable, "-m", __name__]
        with log.open("wb") as output:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=output, text=True
            )
        assert self._process.stdout is not None
        with self._process.stdout as told:
            self.uri = told.readline().strip()
        if not self.uri:
            status = self._process.wait()
            words = log.read_text(encoding="utf-8", errors="replace").strip().rpartition("\n")[2]
            raise MasterFailed(f"the ROS master has ended with exit status {status}: {words or 'it printed nothing'}")

    @property
    def pid(self) -> int:
        return self._process.pid

    def alive(self) -> bool:
        return self._process.poll() is None

    def stop(self) -> None:
        self._process.terminate()
        self._process.wait()

    def __enter__(self) -> OwnMaster:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()


def serve_master() -> tuple[Master, str]:
    """Start a ROS master in threads of this process, on a port that the system gives; the master and its URI."""
    from rosmaster.master import Master

    master = Master(port=0)
    master.start()  # returns when it listens
    return master, f"http://127.0.0.1:{master.master_node.port}"


def main() -> None:
    """Serve a master until the process is told to end; its URI is the one line on standard output."""
    master, uri = serve_master()
    print(uri, flush=True)
    while master.ok():
        time.sleep(LOOK_PERIOD)


if __name__ == "__main__":
    main()
