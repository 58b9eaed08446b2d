"""A program that a benchmark starts, waits for by what it says, and ends by its process id."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import threading
import time
from collections import deque
from typing import Mapping, Sequence

from .errors import BenchmarkError

KEPT_LINES = 200
NOTHING: Mapping[str, str] = {}
PATIENCE = 8.0
"""How long a program may take to end after an interrupt, in s, before it is killed."""


class Program:
    """A process of ours; its output is read all the time, so that it never waits for us.

    Attributes:
        name: How errors call it.
        pid: Its process id, which is also that of its process group.

    Args:
        name: See above.
        command: Program and arguments.
        environment: What to add to the environment.
    """

    def __init__(self, name: str, command: Sequence[str], environment: Mapping[str, str] = NOTHING) -> None:
        self.name = name
        self._process = subprocess.Popen(
            list(command),
            env={**os.environ, "PYTHONUNBUFFERED": "1", **environment},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            start_new_session=True,  # Ctrl-C is for us; we end the program in our order
        )
        self.pid = self._process.pid
        self._lines: deque[str] = deque(maxlen=KEPT_LINES)
        self._ended = False
        self._changed = threading.Condition()
        self._reader = threading.Thread(target=self._read, name=f"output of {name}", daemon=True)
        self._reader.start()

    def __enter__(self) -> Program:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    @property
    def output(self) -> str:
        """The last lines it wrote."""
        with self._changed:
            return "\n".join(self._lines)

    def wait_for(self, pattern: str, limit: float) -> re.Match[str]:
        """Wait for a line of its output; those that it wrote before count as well.

        Args:
            pattern: Regular expression, searched in each line.
            limit: Longest wait, in s.

        Raises:
            BenchmarkError: If no such line came before the limit or the end of the program.
        """
        deadline = time.monotonic() + limit
        with self._changed:
            while True:
                for line in self._lines:
                    found = re.search(pattern, line)
                    if found:
                        return found
                if self._ended:
                    raise self._error("ended early")
                left = deadline - time.monotonic()
                if left <= 0.0:
                    raise self._error(f"did not say {pattern!r} within {limit:g} s")
                self._changed.wait(left)

    def wait(self, limit: float) -> str:
        """Wait for its end; returns its output.

        Args:
            limit: Longest wait, in s.

        Raises:
            BenchmarkError: If it does not end in time, or fails.
        """
        try:
            status = self._process.wait(limit)
        except subprocess.TimeoutExpired:
            raise self._error(f"did not end within {limit:g} s") from None
        self._reader.join(PATIENCE)
        if status:
            raise self._error(f"ended with status {status}")
        return self.output

    def stop(self) -> None:
        """End it: ask, wait, then force; and whatever it started with it."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(PATIENCE)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.pid, signal.SIGKILL)
        self._process.wait()
        self._reader.join(PATIENCE)

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as output:
            for line in output:
                with self._changed:
                    self._lines.append(line.rstrip("\n"))
                    self._changed.notify_all()
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def _error(self, problem: str) -> BenchmarkError:
        lines = list(self._lines)[-15:]
        return BenchmarkError("\n    ".join([f"{self.name} {problem}; it said:", *(lines or ["(nothing)"])]))
