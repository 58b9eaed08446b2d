"""A simulated robot with all its nodes, on a ROS master and ports of its own, for as long as a program needs it."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

START_LIMIT = 90.0
PERIOD = 0.05
COLOUR = re.compile(r"\x1b\[[\d;]*m")
LIMITS = ((signal.SIGINT, 40.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 5.0))
"""Signals in turn, and s that roslaunch may take after each. It kills nodes that do not end themselves after 17 s; if
it were killed before, they would be left."""


class OwnStack:
    """Simulator, driver and action servers, started by roslaunch on free ports.

    Args:
        log: File for the output of roslaunch and the nodes.
        arguments: Of the launch file, by name.
        launch: What roslaunch starts: package and launch file, or the path of one.
        ros_port: Of a ROS master that runs already; None for one of its own.
    """

    def __init__(
        self,
        log: Path,
        arguments: Mapping[str, str],
        launch: Sequence[str] = ("nao_library", "nao_sim.launch"),
        ros_port: int | None = None,
    ) -> None:
        self.ros_port, self.nao_port = ros_port or free_port(), free_port()
        self.log = log
        # It gets Ctrl-C when this process is killed, and ends its nodes.
        command = ["setpriv", "--pdeathsig", "INT", "roslaunch", "--port", str(self.ros_port), *launch]
        command += [f"{name}:={value}" for name, value in {"nao_port": str(self.nao_port), **arguments}.items()]
        with log.open("wb") as output, _interruptible():
            self._process = subprocess.Popen(
                command,
                stdout=output,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                start_new_session=True,
                env={**os.environ, "ROS_MASTER_URI": self.master_uri},
            )

    @property
    def master_uri(self) -> str:
        return f"http://127.0.0.1:{self.ros_port}"

    @property
    def pid(self) -> int:
        return self._process.pid

    def alive(self) -> bool:
        return self._process.poll() is None

    def wait_for_master(self, limit: float = START_LIMIT) -> None:
        """Wait up to `limit` s until the ROS master answers: nodes can be made then.

        Raises TimeoutError if it does not, or roslaunch has ended.
        """
        self._wait_for("the ROS master", self.ros_port, limit)

    def wait_for_robot(self, limit: float = START_LIMIT) -> None:
        """Wait up to `limit` s until the simulated robot answers: parameters are set then, and nodes come up.

        Raises TimeoutError if it does not, or roslaunch has ended.
        """
        self._wait_for("the simulated robot", self.nao_port, limit)

    def _wait_for(self, what: str, port: int, limit: float) -> None:
        """No event says that a port is open: look again and again, but notice the end of roslaunch."""
        deadline = time.monotonic() + limit
        while not can_connect(port):
            if self._ended_within(PERIOD):
                raise TimeoutError(f"{what} does not come up: roslaunch has ended: {self._last_words()}")
            if time.monotonic() > deadline:
                raise TimeoutError(f"{what} does not come up: not there within {limit:g} s")

    def _last_words(self) -> str:
        """The last error of roslaunch, up to 300 characters; empty if it printed none."""
        text = COLOUR.sub("", self.log.read_text(encoding="utf-8", errors="replace"))
        return " ".join(line for line in text.splitlines() if line.strip()).rpartition("RLException: ")[2][-300:]

    def _ended_within(self, seconds: float) -> bool:
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return True

    def stop(self) -> None:
        for number, limit in LIMITS:
            if self.alive():
                self._process.send_signal(number)
                self._ended_within(limit)

    def __enter__(self) -> OwnStack:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()


@contextmanager
def _interruptible() -> Iterator[None]:
    """Programs that are started here can be ended by Ctrl-C, also where this thread blocks it, as in workers of Ray."""
    before = signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def can_connect(port: int) -> bool:
    """Whether a program listens on a port of this computer."""
    with socket.socket() as probe:
        probe.settimeout(1.0)
        return probe.connect_ex(("127.0.0.1", port)) == 0


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
