"""What a detector is, and which there are. They get pixels and optics, and nothing of what the simulation knows."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Protocol

import numpy as np

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.cameras.optics import Optics

# Full names of the classes, imported when they are wanted: not every robot looks for faces.
DETECTORS = {
    "ball": "nao_sim_bridge.vision.ball.BallDetector",
    "landmarks": "nao_sim_bridge.vision.landmarks.LandmarkDetector",
    "barcodes": "nao_sim_bridge.vision.barcodes.BarcodeDetector",
    "faces": "nao_sim_bridge.vision.faces.FaceDetector",
    "movement": "nao_sim_bridge.vision.movement.MovementDetector",
}


class Detector(Protocol):
    """Finds one kind of thing in pictures; each user has an instance of its own, which may remember earlier pictures.

    It runs in the vision process: settings, results and the arguments and results of further methods are pickled.
    """

    def detect(self, image: np.ndarray, optics: Optics, settings: Any) -> Any:
        """What is in a picture.

        Args:
            image: (height, width, 3) uint8, blue, green, red; read-only.
            optics: How it was projected; its places are normalised.
            settings: Whatever its user gives with the picture.
        """


def make_detector(name: str, arguments: tuple = ()) -> Detector:
    """A new detector.

    Raises:
        UnknownName: There is none of this name.
    """
    if name not in DETECTORS:
        raise UnknownName("detector", name, DETECTORS)
    module, _, kind = DETECTORS[name].rpartition(".")
    return getattr(import_module(module), kind)(*arguments)
