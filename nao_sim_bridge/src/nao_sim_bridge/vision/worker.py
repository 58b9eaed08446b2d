"""The vision process: `python -m nao_sim_bridge.vision.worker FD`.

Its detectors get pixels and optics, and nothing of what the simulation knows.

It talks over the inherited pipe FD in tuples (kind, content). First it sends ("ready", None). Then it answers
("open", (key, name, arguments)), which makes a detector, and ("close", key), which drops it, with None, and
("call", (key, method, arguments)) with what the method returns; or ("error", text). It ends when the pipe is closed.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any, Iterable, Protocol

import cv2
import numpy as np

from nao_sim_bridge.base.child_process import pipe_to_parent, serve
from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.cameras.optics import Optics

# Full names of the classes, imported when they are wanted: not every robot looks for faces.
DETECTORS = {
    "ball": "nao_sim_bridge.vision.ball.BallDetector",
    "landmarks": "nao_sim_bridge.vision.landmarks.LandmarkDetector",
    "barcodes": "nao_sim_bridge.vision.barcodes.BarcodeDetector",
    "faces": "nao_sim_bridge.vision.faces.FaceDetector",
    "movement": "nao_sim_bridge.vision.movement.MovementDetector",
    "color blob": "nao_sim_bridge.vision.color_blob.ColorBlobDetector",
    "pictures": "nao_sim_bridge.vision.picture_features.PictureDetector",
    "darkness": "nao_sim_bridge.vision.light.DarknessDetector",
    "backlighting": "nao_sim_bridge.vision.light.BacklightingDetector",
}


class Detector(Protocol):
    """Finds one kind of thing in pictures; each user has an instance of its own, which may remember earlier pictures.

    It runs in the vision process: settings, results and the arguments and results of further methods are pickled.
    """

    def detect(self, image: np.ndarray, optics: Optics, settings: Any) -> Any:
        """What is in a (height, width, 3) uint8 picture, blue, green, red, read-only; settings are its user's.

        `optics`: how the picture was projected; places in results are normalised.
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


class Detectors:
    """The detectors of the process, by the keys of their users."""

    def __init__(self) -> None:
        self._detectors: dict[int, Detector] = {}

    def open(self, content: tuple[int, str, tuple]) -> None:
        key, name, arguments = content
        self._detectors[key] = make_detector(name, arguments)

    def close(self, key: int) -> None:
        self._detectors.pop(key, None)

    def call(self, content: tuple[int, str, tuple]) -> Any:
        key, method, arguments = content
        return getattr(self._detectors[key], method)(*arguments)


def main(arguments: Iterable[str]) -> int:
    """Serve one pipe until it is closed."""
    (descriptor,) = arguments
    pipe = pipe_to_parent(descriptor)
    cv2.setNumThreads(1)  # the other cores are for physics and drawing
    pipe.send(("ready", None))
    detectors = Detectors()
    return serve(pipe, {"open": detectors.open, "close": detectors.close, "call": detectors.call})


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
