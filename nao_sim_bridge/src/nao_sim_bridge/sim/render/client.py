"""The handle of the picture process: starts it, asks it for pictures, starts it again when it has died."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np

from nao_sim_bridge.sim.errors import SimulationError
from nao_sim_bridge.sim.render.scene import Camera, RenderState

START_TIMEOUT = 60.0
"""s; building the robot takes well below one, but a busy machine may need long to start an interpreter."""
STOP_TIMEOUT = 2.0
SOURCES = Path(__file__).resolve().parents[3]


class RenderError(SimulationError):
    """A picture could not be made; the next request starts the process again if it has to."""


class PictureRefused(RenderError):
    """The picture process is well but cannot make this picture."""


class _Worker:
    """One picture process and the pipe to it.

    A process that is started by name, not forked or spawned by multiprocessing: it must not run the caller's
    main program again. It ends by itself when the other end of its pipe is closed, so it cannot outlive its
    parent.
    """

    def __init__(self, mode: str, world_name: str, version: str) -> None:
        here, there = os_pipe()
        paths = [str(SOURCES), os.environ.get("PYTHONPATH", "")]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
        command = [sys.executable, "-m", "nao_sim_bridge.sim.render.worker"]
        try:
            self.process = subprocess.Popen(
                [*command, str(there.fileno()), mode, world_name, version],
                pass_fds=(there.fileno(),),
                stdin=subprocess.DEVNULL,
                # The window talks about its threads on the standard output.
                stdout=subprocess.DEVNULL if mode == "window" else None,
                env=environment,
            )
        finally:
            there.close()
        self.pipe = here

    def receive(self, timeout: float, what: str) -> Any:
        """The next answer; an error it reports is raised.

        Raises:
            PictureRefused: If it reports an error.
            RenderError: If it has ended or does not answer in time.
        """
        try:
            if not self.pipe.poll(timeout):
                raise RenderError(f"{what}: no answer of the picture process within {timeout:g} s")
            kind, content = self.pipe.recv()
        except (EOFError, OSError) as error:
            raise RenderError(f"{what}: {self.last_words()}") from error
        if kind == "error":
            raise PictureRefused(f"{what}: {content}")
        return content

    def last_words(self) -> str:
        """How the process ended."""
        try:
            return f"the picture process ended with status {self.process.wait(STOP_TIMEOUT)}"
        except subprocess.TimeoutExpired:
            return "the picture process closed its pipe"

    def stop(self) -> None:
        """End it: by closing the pipe, and if that does not help, by force."""
        self.pipe.close()
        try:
            self.process.wait(STOP_TIMEOUT)
        except subprocess.TimeoutExpired:
            self.kill()

    def kill(self) -> None:
        """End it by force."""
        self.pipe.close()
        self.process.kill()
        self.process.wait()


def os_pipe() -> tuple[Connection, Connection]:
    """Two connected ends of a two-way pipe."""
    from multiprocessing import Pipe  # starts nothing

    return Pipe(duplex=True)


class Renderer:
    """Makes pictures in a process of its own. Any thread may ask; one picture is made at a time.

    Args:
        world_name: Name or path of the world.
        version: Robot version.
    """

    def __init__(self, world_name: str = "empty", version: str = "V6") -> None:
        self._world_name = world_name
        self._version = version
        self._worker: _Worker | None = None
        self._lock = threading.Lock()

    @property
    def pid(self) -> int | None:
        """Process id of the picture process; None while there is none."""
        worker = self._worker
        return worker.process.pid if worker is not None else None

    def start(self) -> Renderer:
        """Start the process now and wait until it is ready; else the first picture does.

        Raises:
            RenderError: If it does not come up, or the world cannot be read.
        """
        with self._lock:
            self._ensure_worker()
        return self

    def render(self, state: RenderState, camera: Camera, timeout: float = 10.0) -> np.ndarray:
        """Make a picture.

        Args:
            state: What is to be seen.
            camera: From where.
            timeout: Longest time to wait for the picture, s; starting the process does not count.

        Returns:
            (h, w, 3) uint8 RGB picture.

        Raises:
            RenderError: If the process dies, is late, or cannot draw this.
        """
        with self._lock:
            worker = self._ensure_worker()
            try:
                worker.pipe.send(("render", (state, camera)))
                shape = worker.receive(timeout, "picture")
                pixels = worker.pipe.recv_bytes()
            except PictureRefused:
                raise
            except (OSError, EOFError, RenderError) as error:
                # It is gone, or late: its answer would be taken for that of the next request.
                words = str(error) if isinstance(error, RenderError) else f"picture: {worker.last_words()}"
                self._worker = None
                worker.kill()
                raise RenderError(words) from error
        return np.frombuffer(pixels, dtype=np.uint8).reshape(shape)

    def close(self) -> None:
        """End the process; a later picture would start it again."""
        with self._lock:
            self._drop_worker()

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _ensure_worker(self) -> _Worker:
        if self._worker is None:
            worker = _Worker("pictures", self._world_name, self._version)
            try:
                worker.receive(START_TIMEOUT, "starting")
            except RenderError:
                worker.stop()
                raise
            self._worker = worker
        return self._worker

    def _drop_worker(self) -> None:
        if self._worker is not None:
            self._worker.stop()
            self._worker = None


class Viewer:
    """A window that mirrors the simulation, in a process of its own. States are shown at up to 30 Hz.

    Args:
        world_name: Name or path of the world.
        version: Robot version.
    """

    def __init__(self, world_name: str = "empty", version: str = "V6") -> None:
        self._world_name = world_name
        self._version = version
        self._worker: _Worker | None = None
        self._drawing = False

    def start(self) -> Viewer:
        """Open the window.

        Raises:
            RenderError: If there is no display, or the window does not open.
        """
        if not os.environ.get("DISPLAY"):
            raise RenderError("window: there is no display (DISPLAY is not set); leave the window out, or set it")
        worker = _Worker("window", self._world_name, self._version)
        try:
            worker.receive(START_TIMEOUT, "window")
        except RenderError:
            worker.stop()
            raise
        self._worker, self._drawing = worker, False
        return self

    def show(self, state: RenderState) -> None:
        """Show a state, or leave it out when the window still draws another one; never waits.

        Raises:
            RenderError: If the window has been closed.
        """
        if self._worker is None:
            raise RenderError("window: it is not open")
        pipe = self._worker.pipe
        try:
            if self._drawing and pipe.poll():
                pipe.recv()
                self._drawing = False
            if not self._drawing:
                pipe.send(("show", state))
                self._drawing = True
        except (OSError, EOFError) as error:
            raise RenderError(f"window: {self._worker.last_words()}") from error

    def close(self) -> None:
        """Close the window."""
        if self._worker is not None:
            self._worker.stop()
            self._worker = None
