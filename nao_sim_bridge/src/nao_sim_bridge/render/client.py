"""The handle of the picture process: starts it, asks it for pictures, starts it again when it has died."""

from __future__ import annotations

import logging
import os
import threading
from typing import TYPE_CHECKING, Any, Callable

import numpy as np

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.renderers import require_renderer
from nao_sim_bridge.world.render_state import Camera, RenderState, StateSender

if TYPE_CHECKING:
    from nao_sim_bridge.cameras.sensor import Shot
    from nao_sim_bridge.render.window import Ray

START_TIMEOUT = 60.0
"""s; building the robot takes well below one, but a busy machine may need long to start an interpreter."""
MODULE = "nao_sim_bridge.render.worker"


class RenderError(SimulationError):
    """A picture could not be made; the next request starts the process again if it has to."""


class PictureRefused(RenderError):
    """The picture process is well but cannot make this picture."""


log = logging.getLogger("nao_sim.pictures")


def _started(mode: str, world_name: str, version: str, what: str) -> tuple[ChildProcess, Any]:
    """A new picture process that is ready, and what it says of itself."""
    arguments, window = (mode, world_name, version), mode == "window"
    # A window talks about its threads on the standard output, which nobody wants to read.
    worker = ChildProcess(MODULE, arguments, "picture process", RenderError, PictureRefused, silent=window)
    try:
        return worker, worker.receive(START_TIMEOUT, what)
    except RenderError:
        worker.stop()
        raise


class Renderer:
    """Makes pictures in a process of its own. Any thread may ask; one picture is made at a time.

    When a process that has made pictures ends by itself, the next one is asked for the same picture, once: who records
    or looks does not notice.

    Args:
        world_name: Name or path of the world.
        engine: What draws: "opengl"; "builtin", which is slower and needs nothing of the computer; or "auto" for
            OpenGL where it can be had.

    Attributes:
        engine: What draws, in words; None before the process has been started.

    Raises:
        UnknownName: There is no such engine.
    """

    def __init__(self, world_name: str = "empty", version: str = "V6", engine: str = "auto") -> None:
        require_renderer(engine)
        self._world_name = world_name
        self._version = version
        self._asked = engine
        self.engine: str | None = None
        self._worker: ChildProcess | None = None
        self._sender = StateSender()
        self._proven = False  # the process has made a picture
        self._late = False  # the last one was ended because it did not answer
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
        """Make a (h, w, 3) uint8 RGB picture within `timeout` s; starting the process does not count.

        Raises:
            RenderError: If the process dies, is late, or cannot draw this.
        """
        shape, pixels = self._ask("render", state, camera, timeout)
        return np.frombuffer(pixels, dtype=np.uint8).reshape(shape)

    def capture(self, state: RenderState, shot: Shot, timeout: float = 10.0) -> bytes:
        """Make what a camera in the robot's head gives, as `render` does: `read_photograph` reads it."""
        return self._ask("capture", state, shot, timeout)[1]

    def close(self) -> None:
        """End the process; a later picture would start it again."""
        with self._lock:
            if self._worker is not None:
                self._worker.stop()
                self._worker = None

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _ask(self, kind: str, state: RenderState, subject: Camera | Shot, timeout: float) -> tuple[Any, bytes]:
        """The answer to a request, and the bytes that follow it."""
        with self._lock:
            try:
                return self._ask_once(kind, state, subject, timeout)
            except RenderError as error:
                # One that dies of its first picture would do so again; one that is late has had its time.
                hopeless = not self._proven or self._worker is not None or self._late
                if hopeless or isinstance(error, PictureRefused):
                    raise
                log.warning("%s; it is started again", error)
            return self._ask_once(kind, state, subject, timeout)

    def _ask_once(self, kind: str, state: RenderState, subject: Camera | Shot, timeout: float) -> tuple[Any, bytes]:
        worker = self._ensure_worker()
        content = (self._sender.pack(state), subject)
        try:
            answer = worker.ask(kind, content, timeout, "picture"), worker.receive_bytes("picture")
        finally:
            if worker.over:
                self._worker, self._late = None, worker.late
        self._proven = True
        return answer

    def _ensure_worker(self) -> ChildProcess:
        if self._worker is None:
            worker, (engine, complaint) = self._start_worker()
            if self.engine is None:
                if complaint:
                    log.warning("%s", complaint)
                log.info("pictures are drawn by %s", engine)
            self._worker, self.engine, self._sender = worker, engine, StateSender()
            self._proven = False
        return self._worker

    def _start_worker(self) -> tuple[ChildProcess, tuple[str, str | None]]:
        """A process that is ready, what draws in it, and what is to be complained of."""
        place = (self._world_name, self._version, "starting")
        try:
            return _started(f"pictures:{self._asked}", *place)
        except RenderError as error:
            if self._asked != "auto" or isinstance(error, PictureRefused):
                raise
            # A driver may take its process with it.
            worker, (engine, _) = _started("pictures:builtin", *place)
            return worker, (engine, f"pictures are drawn slowly, for with OpenGL there is an error: {error}")


class Viewer:
    """A window that mirrors the simulation, in a process of its own. States are shown at up to 30 Hz.

    Attributes:
        on_pointer: Called in `show` with the line of sight through the mouse while its button is pressed, and with None
            when it is released.
    """

    def __init__(self, world_name: str = "empty", version: str = "V6") -> None:
        self._world_name = world_name
        self._version = version
        self._worker: ChildProcess | None = None
        self._sender = StateSender()
        self._drawing = False
        self.on_pointer: Callable[[Ray | None], None] = lambda _: None

    def start(self) -> Viewer:
        """Open the window.

        Raises:
            RenderError: If there is no display, or the window does not open.
        """
        if not os.environ.get("DISPLAY"):
            raise RenderError("window: there is no display (DISPLAY is not set); leave the window out, or set it")
        self._worker, _ = _started("window", self._world_name, self._version, "window")
        self._drawing, self._sender = False, StateSender()
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
            while pipe.poll():
                kind, content = pipe.recv()
                if kind == "pointer":
                    self.on_pointer(content)
                else:
                    self._drawing = False
            if not self._drawing:
                pipe.send(("show", self._sender.pack(state)))
                self._drawing = True
        except (OSError, EOFError) as error:
            raise RenderError(f"window: {self._worker.last_words()}") from error

    def close(self) -> None:
        if self._worker is not None:
            self._worker.stop()
            self._worker = None
