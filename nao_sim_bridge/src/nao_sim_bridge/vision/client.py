"""The handle of the vision process: detectors at work in it, and a new process when one has died."""

from __future__ import annotations

import itertools
import logging
import threading
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.cameras.optics import Optics

log = logging.getLogger("nao_sim.vision")

MODULE = "nao_sim_bridge.vision.worker"
START_TIMEOUT = 60.0
"""s; a busy machine may need long to start an interpreter."""
ANSWER_TIMEOUT = 30.0
CLOSING = 1.0
"""s; at the end, a process that is still busy after this is ended by force."""
DEATHS = 4
"""A detector whose work ended the process this often in a row is not asked again."""


class VisionError(SimulationError):
    """The vision process died or does not answer; it is started again when there is something to do."""


class VisionClosed(VisionError):
    """The process was closed: nobody wants to know any more."""


class VisionRefused(VisionError):
    """The process is well, but a detector failed."""


class VisionProcess:
    """One process for all detectors of a robot; it starts with the first work. Any thread may call.

    Requests are answered one at a time, in no particular order.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()  # for the pipe: held from a request to its answer
        self._keys = itertools.count(1)
        self._process: ChildProcess | None = None
        self._closed = False

    @property
    def pid(self) -> int | None:
        """Process id; None while there is no process."""
        process = self._process
        return process.process.pid if process is not None else None

    def detector(self, name: str, arguments: Callable[[], tuple] = tuple) -> RemoteDetector:
        """A detector of one's own, by its name in `DETECTORS`.

        `arguments` gives those of its constructor. It is called again when the detector has to be made again in a new
        process, so it gives what must not be lost with the old one.
        """
        return RemoteDetector(self, name, arguments, next(self._keys))

    def close(self) -> None:
        """End the process; who waits for an answer gets an error."""
        self._closed = True
        free = self._lock.acquire(timeout=CLOSING)
        try:
            process, self._process = self._process, None
            if process is None:
                return
            if free:
                process.stop()
            else:
                process.process.kill()  # who waits for it notices
        finally:
            if free:
                self._lock.release()

    def ask(self, detector: RemoteDetector, method: str, arguments: tuple) -> Any:
        """Have a detector work; see `RemoteDetector.call`."""
        with self._lock:
            for last in (False, True):
                if self._closed:
                    raise VisionClosed(f"{detector.name}: the vision process is closed")
                if detector.deaths >= DEATHS:
                    raise VisionError(f"{detector.name}: ended the vision process {DEATHS} times")
                try:
                    answer = self._ask(detector, method, arguments)
                except VisionRefused:
                    raise
                except VisionError as error:
                    self._process = None
                    detector.deaths += 1
                    if self._closed:
                        raise VisionClosed(f"{detector.name}: the vision process was closed meanwhile") from error
                    if last:
                        raise
                    log.warning("%s; it is started again", error)
                else:
                    detector.deaths = 0
                    return answer
        raise AssertionError("the second round returns or raises")

    def forget(self, detector: RemoteDetector) -> None:
        with self._lock:
            process = self._process
            if process is None or process is not detector.home:
                return
            try:
                process.ask("close", detector.key, ANSWER_TIMEOUT, detector.name)
            except VisionError as error:
                log.warning("%s", error)
                self._process = None

    def _ask(self, detector: RemoteDetector, method: str, arguments: tuple) -> Any:
        process = self._running()
        if detector.home is not process:
            content = (detector.key, detector.name, detector.arguments())
            process.ask("open", content, ANSWER_TIMEOUT, detector.name)
            detector.home = process
        return process.ask("call", (detector.key, method, arguments), ANSWER_TIMEOUT, detector.name)

    def _running(self) -> ChildProcess:
        if self._process is None:
            process = ChildProcess(MODULE, (), "vision process", VisionError, VisionRefused)
            process.receive(START_TIMEOUT, "start of vision")
            self._process = process
        return self._process


class RemoteDetector:
    """A detector in the vision process.

    When the process dies at work, the detector is made again in a new one and the same work is asked for again, once.
    """

    def __init__(self, process: VisionProcess, name: str, arguments: Callable[[], tuple], key: int) -> None:
        self.name, self.key = name, key
        self.arguments = arguments
        # For VisionProcess: where it is now, and how often in a row its work ended the process.
        self.home: ChildProcess | None = None
        self.deaths = 0
        self._process = process

    def detect(self, image: np.ndarray, optics: Optics, settings: Any = None) -> Any:
        """What is in a picture, see `Detector`; blocks until it is known.

        Raises:
            VisionRefused: The detector failed.
            VisionClosed: It is closed.
            VisionError: The process died twice, or is late.
        """
        return self.call("detect", np.ascontiguousarray(image), optics, settings)

    def call(self, method: str, *arguments: Any) -> Any:
        """Another method of the detector; blocks, and raises as `detect`."""
        return self._process.ask(self, method, arguments)

    def close(self) -> None:
        """Forget what it remembers; used again, it is a new one."""
        self._process.forget(self)
        self.home = None
        self.deaths = 0
