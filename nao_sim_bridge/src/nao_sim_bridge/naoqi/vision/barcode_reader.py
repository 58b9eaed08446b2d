"""ALBarcodeReader of the simulated robot."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.settings import CameraTables
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.sight import Sight
from nao_sim_bridge.naoqi.vision.vision_extractor import VisionExtractor
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.barcodes import Barcode
from nao_sim_bridge.vision.client import VisionProcess

NAME, EVENT = "ALBarcodeReader", "BarcodeReader/BarcodeDetected"
FPS = 10
VGA = 2
"""In smaller pictures the stripes of a barcode cannot be told apart."""


class BarcodeReader:
    """Reads barcodes and QR codes, with each picture in which there is one.

    The event `BarcodeReader/BarcodeDetected` has [[text, [[x, y], [x, y], [x, y], [x, y]]], ...], corners in pixels of
    the picture, from the upper left one as the code is read, clockwise. When no code is seen any more, its value is
    an empty list, and nobody is told. At the start it looks at 640x480.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> None:
        self._sight = Sight(memory, EVENT, tell_end=False)
        self.watching = Watching(
            simulation.cameras,
            NAME,
            vision.detector("barcodes"),
            self._on_result,
            on_stop=self._sight.nothing,
            resolution=VGA,
            fps=FPS,
        )

    def _on_result(self, frame: Frame, found: list[Barcode]) -> None:
        if found:
            self._sight.show([[code.text, [list(corner) for corner in code.corners]] for code in found])
        else:
            self._sight.nothing()


def parts(watching: Watching, memory: MemoryStore, tables: CameraTables) -> list[Any]:
    """The objects that together have the methods of ALBarcodeReader."""
    extractor = Extractor(NAME, memory, watching.start, watching.stop, [EVENT], changed=watching.changed)
    return [VisionExtractor(watching, tables), extractor]
