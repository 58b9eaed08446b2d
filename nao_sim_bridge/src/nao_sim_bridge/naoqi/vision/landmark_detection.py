"""ALLandMarkDetection of the simulated robot."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.settings import CAMERA_NAMES, CameraTables
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.sight import Sight
from nao_sim_bridge.naoqi.vision.vision_extractor import VisionExtractor
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.client import VisionProcess
from nao_sim_bridge.vision.landmarks import Landmark

NAME, EVENT = "ALLandMarkDetection", "LandmarkDetected"
FPS = 15
SHAPE = 1
"""What NAOqi writes in front of the shape of a mark."""


class LandMarkDetection:
    """Tells which landmarks are where, with each picture in which there is one.

    The event `LandmarkDetected` has [[seconds, microseconds], [mark, ...], pose of the camera in FRAME_TORSO, the same
    in FRAME_ROBOT, name of the camera], with a mark as [[1, alpha, beta, size X, size Y, heading], [number]] in rad:
    middle, width and height of its black disc as angles in the picture (alpha positive to the left, beta downwards),
    heading its turn in the picture, counterclockwise. When the last mark has disappeared, the event is raised once
    with an empty list.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> None:
        self._sight = Sight(memory, EVENT, tell_end=True)
        self.watching = Watching(
            simulation.cameras,
            NAME,
            vision.detector("landmarks"),
            self._on_result,
            on_stop=self._sight.nothing,
            fps=FPS,
        )

    def _on_result(self, frame: Frame, found: list[Landmark]) -> None:
        if found:
            self._sight.show(landmark_value(frame, found))
        else:
            self._sight.nothing()


def landmark_value(frame: Frame, found: list[Landmark]) -> list[Any]:
    marks = [[[SHAPE, m.alpha, m.beta, m.width, m.height, m.heading], [m.number]] for m in found]
    poses = [list(frame.pose_in_torso), list(frame.pose_in_robot)]
    return [list(frame.stamp), marks, *poses, CAMERA_NAMES[frame.camera]]


def parts(watching: Watching, memory: MemoryStore, tables: CameraTables) -> list[Any]:
    """The objects that together have the methods of ALLandMarkDetection."""
    extractor = Extractor(NAME, memory, watching.start, watching.stop, [EVENT], changed=watching.changed)
    return [VisionExtractor(watching, tables), extractor]
