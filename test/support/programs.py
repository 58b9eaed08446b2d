"""Programs as documents print them: what is typed runs in a shell, and nothing of it is left."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from nao_library_modules.core.processes import ProcessId, descendants, kill_survivors

PORT = "9559"
"""The port of the robot in commands and programs, as it is without arguments."""


@dataclass(frozen=True)
class Ended:
    """How a program ended.

    Attributes:
        status: Exit status; None if it did not end in time.
        output: What it printed, errors as well.
        seconds: How long it took, s of wall time.
    """

    status: int | None
    output: str
    seconds: float

    def __str__(self) -> str:
        """Output and status, as people read them."""
        ended = "did not end" if self.status is None else f"status {self.status}"
        return f"{self.output.rstrip()}\n[{ended} after {self.seconds:.1f} s]"


def at_port(text: str, port: int) -> str:
    """A command or a program for a robot that is not at the usual port."""
    return re.sub(rf"\b{PORT}\b", str(port), text)


class Program:
    """A running program, the leader of a process group of its own; it reads nothing.

    Args:
        words: Program and arguments.
        folder: Where it runs; files that it writes are there.
        environment: Variables.
    """

    def __init__(self, words: Sequence[str], folder: Path, environment: Mapping[str, str]) -> None:
        self._began = time.monotonic()
        self._output = tempfile.TemporaryFile()
        self._process = subprocess.Popen(
            words,
            cwd=folder,
            env=dict(environment),
            stdin=subprocess.DEVNULL,
            stdout=self._output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    @property
    def failed(self) -> bool:
        """Whether it has ended, with another status than 0."""
        return self._process.poll() not in (None, 0)

    @property
    def output(self) -> str:
        """What it has printed until now, errors as well."""
        size = os.fstat(self._output.fileno()).st_size
        return os.pread(self._output.fileno(), size, 0).decode("utf-8", errors="replace")

    def interrupt(self) -> None:
        """Ctrl-C."""
        self._signal(signal.SIGINT)

    def end(self, limit: float) -> Ended:
        """Wait for its end, s of wall time; then kill it and all that it has left in the background.

        Of one that has not ended, also what it has started in sessions of their own, as roslaunch does with nodes.
        """
        below: list[ProcessId] = []
        try:
            status = self._process.wait(limit)
        except subprocess.TimeoutExpired:
            status = None
            below = descendants(self._process.pid)
        finally:
            self._signal(signal.SIGKILL)
            self._process.wait()
            kill_survivors(below)
        with self._output:
            return Ended(status, self.output, time.monotonic() - self._began)

    def _signal(self, number: int) -> None:
        try:
            os.killpg(self._process.pid, number)
        except ProcessLookupError:
            pass  # nothing of it is left


def shell(command: str) -> list[str]:
    """What runs what is typed."""
    return ["bash", "-c", command]
