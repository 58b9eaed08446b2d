"""A Python module in a process of its own, and the pipe to it: for work that must not hold the simulation up.

The process is started by name, not forked or spawned by multiprocessing: it must not run the caller's main program
again. It ends by itself when the other end of its pipe is closed, so it cannot outlive its parent.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import traceback
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Sequence

from nao_sim_bridge.sim.errors import SimulationError

STOP_TIMEOUT = 2.0
SOURCES = Path(__file__).resolve().parents[2]


class ChildProcess:
    """One process that talks in tuples (kind, content); an answer of kind "error" has a text.

    When it has ended by itself or an answer is late, it is ended by force: what it answers later would be taken for the
    answer to the next request.

    Attributes:
        process: The process.
        pipe: This side of the pipe.
        over: Whether it failed or was ended: nothing can be asked any more.
        late: Whether it was ended because an answer did not come in time.

    Args:
        module: Full name of the module that is run; it gets the number of its pipe as the first argument.
        arguments: What else it gets.
        name: What error texts call it, for example "picture process".
        failed: Class of the error for a process that died or is late.
        refused: Class of the error for a process that is well and answers with an error.
        silent: Keep what it prints on its standard output to itself.
    """

    def __init__(
        self,
        module: str,
        arguments: Sequence[str],
        name: str,
        failed: type[SimulationError],
        refused: type[SimulationError],
        silent: bool = False,
    ) -> None:
        self._name = name
        self._failed = failed
        self._refused = refused
        self.over = self.late = False
        here, there = Pipe(duplex=True)
        paths = [str(SOURCES), os.environ.get("PYTHONPATH", "")]
        try:
            self.process = subprocess.Popen(
                [sys.executable, "-m", module, str(there.fileno()), *arguments],
                pass_fds=(there.fileno(),),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL if silent else None,
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))},
            )
        finally:
            there.close()
        self.pipe = here

    def send(self, kind: str, content: Any, what: str) -> None:
        """Send a request.

        Args:
            kind: Of the request.
            content: Of the request.
            what: What it is about, for error texts; here and below.

        Raises:
            SimulationError: Of the class `failed`, if it has ended.
        """
        try:
            self.pipe.send((kind, content))
        except OSError as error:
            raise self._failure(what, error) from error

    def receive(self, timeout: float, what: str) -> Any:
        """The content of the next answer; an error it reports is raised.

        Raises:
            SimulationError: Of the class `refused` if it reports an error, of the class `failed` if it has ended or
                does not answer in time.
        """
        try:
            if not self.pipe.poll(timeout):
                self.late = True
                self.kill()
                raise self._failed(f"{what}: no answer of the {self._name} within {timeout:g} s")
            kind, content = self.pipe.recv()
        except (EOFError, OSError) as error:
            raise self._failure(what, error) from error
        if kind == "error":
            raise self._refused(f"{what}: {content}")
        return content

    def receive_bytes(self, what: str) -> bytes:
        """Raw bytes that follow an answer.

        Raises:
            SimulationError: Of the class `failed`, if it has ended.
        """
        try:
            return self.pipe.recv_bytes()
        except (EOFError, OSError) as error:
            raise self._failure(what, error) from error

    def ask(self, kind: str, content: Any, timeout: float, what: str) -> Any:
        """Send a request and wait for its answer; see `send` and `receive`."""
        self.send(kind, content, what)
        return self.receive(timeout, what)

    def last_words(self) -> str:
        """How the process ended."""
        try:
            return f"the {self._name} ended with status {self.process.wait(STOP_TIMEOUT)}"
        except subprocess.TimeoutExpired:
            return f"the {self._name} closed its pipe"

    def stop(self) -> None:
        """End it: by closing the pipe, and if that does not help, by force."""
        self.over = True
        self.pipe.close()
        try:
            self.process.wait(STOP_TIMEOUT)
        except subprocess.TimeoutExpired:
            self.kill()

    def kill(self) -> None:
        """End it by force."""
        self.over = True
        self.pipe.close()
        self.process.kill()
        self.process.wait()

    def _failure(self, what: str, error: Exception) -> SimulationError:
        """The error for a process that has gone; what may be left of it is ended."""
        words = self.last_words()
        if self.process.poll() is None:
            words += f" ({error!r})"
        self.kill()
        return self._failed(f"{what}: {words}")


# --- in the process -------------------------------------------------------------------------------------------------


def pipe_to_parent(descriptor: str) -> Connection:
    """The pipe that the process was given, by its first argument."""
    # Ctrl-C in a terminal goes to all processes; the owner of the pipe decides when this one ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    return Connection(int(descriptor))


def error_text(error: Exception) -> str:
    """What to tell about an error: its text, and where it came from when it is not one of ours."""
    return str(error) if isinstance(error, SimulationError) else traceback.format_exc()
