"""Looks at the face in front of the robot to learn it."""

from __future__ import annotations

import logging
import threading
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.cameras.stream import CameraClosed
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.vision.watching import BGR
from nao_sim_bridge.vision.faces import FaceSettings

log = logging.getLogger("nao_sim.faces")

PICTURES, RATE, VGA = 5, 10, 2
"""Pictures that learning takes, in VGA, and how many there are a second."""
LEAST_WIDTH = 24.0
"""Smaller faces are found but not learnt, px in a VGA picture: they show too little."""
LOOK_AGAIN = 1.0
MOST_WAITING = load_sizes().clients.faces
"""Calls that learn a face at the same time, that is one after the other."""


class FaceLearner:
    """Takes pictures of a face; one at a time, each in a thread of its own."""

    def __init__(self, cameras: Any, detector: Any, camera: Callable[[], int]) -> None:
        self._cameras = cameras
        self._detector = detector
        self._camera = camera
        self._lock = threading.Lock()
        self._count = threading.Lock()
        self._waiting = 0
        self._closed = threading.Event()

    def look(self, learn: Callable[[np.ndarray], bool]) -> Task:
        """Look at the face in view; a BadValue when too many calls wait for their turn.

        The task ends with what `learn` answers, or with False when the pictures do not show exactly one face.
        """
        cancelled = threading.Event()

        def cancel(asked: Task) -> None:
            cancelled.set()
            asked.killed = asked.killed or not asked.finished
            asked.finish()

        with self._count:
            if self._waiting >= MOST_WAITING:
                raise BadValue("calls that learn a face", self._waiting + 1, f"at most {MOST_WAITING}")
            self._waiting += 1
        task = Task("learnFace", 0, ask=cancel)

        def run() -> None:
            try:
                with self._lock:
                    description = self._describe(cancelled)
                if not cancelled.is_set():
                    task.finish(description is not None and learn(description))
            except CameraClosed:
                task.finish(error=NaoqiError("the cameras were closed before the face was learnt"))
            except Exception as error:
                if not isinstance(error, (SimulationError, NaoqiError, ValueError)):
                    log.exception("a face could not be learnt")
                task.finish(error=error)
            finally:
                with self._count:
                    self._waiting -= 1

        threading.Thread(target=run, name="learn a face", daemon=True).start()
        return task

    def close(self) -> None:
        self._closed.set()

    def _describe(self, cancelled: threading.Event) -> np.ndarray | None:
        """What the face in view looks like; None when there is none, or more than one, or it is too far away."""
        stream = self._cameras.open("learnFace", self._camera(), VGA, BGR, RATE, every=True)
        try:
            total = None
            for _ in range(PICTURES):
                frame = self._next(stream, cancelled)
                if frame is None:
                    return None
                settings = FaceSettings(frame.time, frame.camera)
                found = self._detector.detect(frame.array(), Optics(frame.hfov, frame.vfov), settings)
                if len(found) != 1 or found[0].box[2] < LEAST_WIDTH:
                    return None
                total = found[0].description if total is None else total + found[0].description
            return total / np.linalg.norm(total)
        finally:
            stream.close()
            self._detector.close()

    def _next(self, stream: Any, cancelled: threading.Event) -> Any:
        while not (cancelled.is_set() or self._closed.is_set()):
            try:
                return stream.take(LOOK_AGAIN)
            except TimeoutError:
                continue
        return None
