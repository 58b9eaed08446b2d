"""Clients of the robot that are ill: one is stopped, one is killed again and again, one loads files for ever."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

PROGRAM = Path(__file__).with_name("ill_client.py")
READY_LIMIT = 20.0
"""s that a client has to be ready; the robot may be dead at the moment."""


class IllClients:
    """Starts them and goes on; a context.

    Attributes:
        killed: How many were killed.
        died: How often the one that loads files ended by itself, as when the robot dies.

    Args:
        address: Of the robot.
        port: Of its NAOqi.
        period: After which time the mortal one is killed, s.
    """

    def __init__(self, address: str, port: int, period: float) -> None:
        self._command = [sys.executable, str(PROGRAM), address, str(port)]
        self._period = period
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="ill clients", daemon=True)
        self.killed = self.died = 0

    def __enter__(self) -> IllClients:
        """Start them."""
        self._thread.start()
        return self

    def __exit__(self, *_: Any) -> None:
        """End them all."""
        self._over.set()
        self._thread.join(3.0 * READY_LIMIT)

    def _run(self) -> None:
        stopped = loader = None
        try:
            while not self._over.is_set():
                loader = self._alive(loader, "loads")
                if stopped is None or stopped.poll() is not None:
                    stopped = self._started("listens")
                    stopped.send_signal(signal.SIGSTOP)
                mortal = self._started("listens")
                self._over.wait(self._period)
                _kill(mortal)
                self.killed += 1
                self.died += loader.poll() is not None
        finally:
            for program in (stopped, loader):
                _kill(program)

    def _alive(self, program: subprocess.Popen[bytes] | None, what: str) -> subprocess.Popen[bytes]:
        return program if program is not None and program.poll() is None else self._started(what)

    def _started(self, what: str) -> subprocess.Popen[bytes]:
        """A client; ready, or dead because the robot is."""
        program = subprocess.Popen([*self._command, what], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        too_late = threading.Timer(READY_LIMIT, program.kill)
        too_late.start()
        for line in program.stdout:  # libqi writes there, too
            if line.strip() == b"ready":
                break
        too_late.cancel()
        return program


def _kill(program: subprocess.Popen[bytes] | None) -> None:
    if program is not None:
        program.kill()
        program.wait()
        program.stdout.close()
