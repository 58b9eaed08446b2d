"""The extractors that look through the cameras put together: their detectors share one process."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision import (
    barcode_reader,
    face_detection,
    landmark_detection,
    movement_detection,
    red_ball_detection,
)
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.client import VisionProcess


class VisionModules:
    """ALRedBallDetection, ALLandMarkDetection, ALBarcodeReader, ALFaceDetection and ALMovementDetection of one robot.

    Attributes:
        watchings: What looks through the cameras.

    Args:
        simulation: Whose cameras these are.
        memory: Where events go.
        files: Where known faces are kept.
        process: The vision process; it starts when somebody is subscribed first.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, files: ClientFiles, process: VisionProcess) -> None:
        self._memory = memory
        self._tables = simulation.cameras.tables
        self._ball = red_ball_detection.RedBallDetection(simulation, memory, process).watching
        self._landmarks = landmark_detection.LandMarkDetection(simulation, memory, process).watching
        self._barcodes = barcode_reader.BarcodeReader(simulation, memory, process).watching
        self._faces = face_detection.ALFaceDetection(simulation, memory, process, files)
        self._movement = movement_detection.ALMovementDetection(simulation, memory, process)
        self.watchings: list[Watching] = [
            self._ball,
            self._landmarks,
            self._barcodes,
            self._faces.watching,
            self._movement.watching,
        ]

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `Service` wants them."""
        return {
            red_ball_detection.NAME: red_ball_detection.parts(self._ball, self._memory),
            landmark_detection.NAME: landmark_detection.parts(self._landmarks, self._memory, self._tables),
            barcode_reader.NAME: barcode_reader.parts(self._barcodes, self._memory, self._tables),
            face_detection.NAME: face_detection.parts(self._faces, self._memory, self._tables),
            movement_detection.NAME: movement_detection.parts(self._movement, self._memory, self._tables),
        }

    def closing(self) -> list[Callable[[], None]]:
        """Steps after which nothing is looked at any more; blocking."""
        return [self._faces.learner.close, *(watching.stop for watching in self.watchings)]
