"""A Python module in a process of its own, and the pipe to it: for work that must not hold the simulation up.

The process is started by name, not forked or spawned by multiprocessing: it must not run the caller's main program
again. It does not outlive its parent: nothing is sent through a second pipe, and when that is closed, be it because the
parent has died, the system ends the process in the middle of its work, whatever that is.
"""

from __future__ import annotations

import fcntl
import os
import resource
import select
import signal
import subprocess
import sys
import time
import traceback
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import SimulationError

STOP_TIMEOUT = 2.0
SOURCES = Path(__file__).resolve().parents[2]


class Deadline:
    """A time limit for a process that leaves out the time it waits for a processor (Linux).

    On a busy computer an answer that takes one second of work may come after a minute.

    Attributes:
        seconds: The limit, s.
        left: s until it is reached; negative afterwards.
    """

    def __init__(self, pid: int, seconds: float) -> None:
        self.seconds = seconds
        self._statistics = Path(f"/proc/{pid}/schedstat")
        self._before = self._waited()
        self._end = time.monotonic() + seconds

    @property
    def left(self) -> float:
        return self._end + self._waited() - self._before - time.monotonic()

    def _waited(self) -> float:
        """Time that its main thread was ready to run and had no processor, s."""
        try:
            return int(self._statistics.read_text("ascii").split()[1]) / 1e9
        except (OSError, ValueError, IndexError):
            return 0.0


class ChildProcess:
    """One process that talks in tuples (kind, content); an answer of kind "error" has a text.

    When it has ended by itself or an answer is late, it is ended by force: what it answers later would be taken for the
    answer to the next request.

    Attributes:
        process: The process.
        pipe: This side of the pipe.
        over: Whether it failed, was ended or was left: nothing can be asked any more.
        late: Whether it was ended because an answer did not come in time.

    Args:
        module: Full name of the module that is run; its first argument is for `pipe_to_parent`.
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
        ended, self._life = Pipe(duplex=False)
        paths = [str(SOURCES), os.environ.get("PYTHONPATH", "")]
        try:
            self.process = subprocess.Popen(
                [sys.executable, "-m", module, f"{there.fileno()},{ended.fileno()}", *arguments],
                pass_fds=(there.fileno(), ended.fileno()),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL if silent else None,
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))},
            )
        finally:
            there.close()
            ended.close()
        self.pipe = here

    def send(self, kind: str, content: Any, what: str) -> None:
        """Send a request.

        Args:
            what: What it is about, for error texts; here and below.

        Raises:
            SimulationError: Of the class `failed`, if it has ended.
        """
        try:
            self.pipe.send((kind, content))
        except OSError as error:
            raise self._failure(what, error) from error

    def deadline(self, seconds: float) -> Deadline:
        """A limit for several answers together."""
        return Deadline(self.process.pid, seconds)

    def receive(self, timeout: float | Deadline, what: str) -> Any:
        """The content of the next answer; an error it reports is raised.

        Args:
            timeout: s, as a `Deadline` counts them.

        Raises:
            SimulationError: Of the class `refused` if it reports an error, of the class `failed` if it has ended or
                does not answer in time.
        """
        deadline = timeout if isinstance(timeout, Deadline) else self.deadline(timeout)
        try:
            while not self.pipe.poll(max(0.0, deadline.left)):
                if deadline.left <= 0.0:
                    self.late = True
                    self.kill()
                    raise self._failed(f"{what}: no answer of the {self._name} within {deadline.seconds:g} s")
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
        try:
            return f"the {self._name} ended with status {self.process.wait(STOP_TIMEOUT)}"
        except subprocess.TimeoutExpired:
            return f"the {self._name} closed its pipe"

    def stop(self) -> None:
        """End it: by closing the pipes, and if that does not help, by force."""
        self.leave()
        try:
            self.process.wait(STOP_TIMEOUT)
        except subprocess.TimeoutExpired:
            self.kill()

    def leave(self) -> None:
        """Close the pipes without waiting for its end: for one that has something to complete."""
        self.over = True
        self.pipe.close()
        self._life.close()

    def kill(self) -> None:
        self.leave()
        self.process.kill()
        self.process.wait()

    def _failure(self, what: str, error: Exception) -> SimulationError:
        """The error for a process that has gone; what may be left of it is ended."""
        words = self.last_words()
        if self.process.poll() is None:
            words += f" ({error!r})"
        if not self.over:
            self.kill()
        return self._failed(f"{what}: {words}")


# --- in the process -------------------------------------------------------------------------------------------------


def pipe_to_parent(descriptors: str, completes: bool = False) -> Connection:
    """The pipe that the process was given by its first argument; one that `completes` something ends by itself."""
    # Ctrl-C in a terminal goes to all processes; the owner of the pipe decides when this one ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    pipe, life = map(int, descriptors.split(","))
    if not completes:
        _end_with(life)
    return Connection(pipe)


def serve(pipe: Connection, requests: Mapping[str, Callable[[Any], Any]]) -> int:
    """Answer each request with what is made of its content, or with an error, until the pipe is closed.

    Args:
        requests: What makes the answer, by the kind of the request, which is that of the answer as well.

    Returns:
        Exit status of the process.
    """
    try:
        while True:
            kind, content = pipe.recv()
            try:
                answer = requests[kind](content)
            except Exception as error:
                pipe.send(("error", error_text(error)))
            else:
                pipe.send((kind, answer))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return 0  # the parent is gone or wants no more


def _end_with(life: int) -> None:
    """Have the system end this process when the other end of a pipe is closed.

    By its signal SIGIO, not by a thread: C code that keeps Python's interpreter would keep that from it.
    """
    signal.signal(signal.SIGIO, signal.SIG_DFL)
    fcntl.fcntl(life, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(life, fcntl.F_SETFL, fcntl.fcntl(life, fcntl.F_GETFL) | os.O_ASYNC)
    closed = select.poll()
    closed.register(life, 0)
    if closed.poll(0):  # before this
        os._exit(0)


def limit_memory(size: int) -> None:
    """Give this process at most `size` bytes of address space; what asks for more gets a MemoryError or crashes."""
    resource.setrlimit(resource.RLIMIT_AS, (size, size))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # a crash over a broken file is no news


def error_text(error: Exception) -> str:
    """What to tell about an error: its text, and where it came from when it is not one of ours."""
    return str(error) if isinstance(error, SimulationError) else traceback.format_exc()
