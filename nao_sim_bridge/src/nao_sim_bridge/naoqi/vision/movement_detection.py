"""ALMovementDetection of the simulated robot."""

from __future__ import annotations

from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.vision_extractor import in_picture
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.client import VisionProcess
from nao_sim_bridge.vision.movement import MovementSettings, MovingCluster

NAME = "ALMovementDetection"
DETECTED, NONE = EVENTS = ["MovementDetection/MovementDetected", "MovementDetection/NoMovement"]
INFO = "MovementDetection/MovementInfo"
FPS = 10
DEFAULT_SENSITIVITY, DEFAULT_DEPTH = 0.8, 0.3


class ALMovementDetection:
    """Tells that something moves in the picture, and where. Only NAOqi methods are public, and `watching`.

    With each picture it raises `MovementDetection/MovementDetected` or `MovementDetection/NoMovement`, without a value,
    but neither of them while the robot moves its camera: then nobody knows. The key `MovementDetection/MovementInfo`
    tells of the last movement: [[seconds, microseconds], [cluster, ...], pose of the camera in FRAME_TORSO, the same
    in FRAME_ROBOT, camera], with a cluster as [[x, y] of its centre of gravity, [x, y, width, height] of the rectangle
    around it, [share of the picture, share of the rectangle] that moves]; angles in rad, x and y of the rectangle are
    its upper left corner.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> None:
        self._memory = memory
        self._sensitivity = DEFAULT_SENSITIVITY
        self._detector = vision.detector("movement")
        self.watching = Watching(
            simulation.cameras, NAME, self._detector, self._on_result, settings=self._settings, fps=FPS
        )
        memory.insert(INFO, [])

    def resetDetection(self) -> None:
        if self.watching.runs:
            self._detector.call("reset")

    def setColorSensitivity(self, sensitivity: float) -> None:
        self._sensitivity = number(sensitivity, "sensitivity", 0.0, 1.0)

    def getColorSensitivity(self) -> float:
        return self._sensitivity

    def setDepthSensitivity(self, _sensitivity: float) -> None:
        raise NaoqiError("a NAO has no depth camera; setColorSensitivity is for those it has")

    def getDepthSensitivity(self) -> float:
        return DEFAULT_DEPTH

    def _settings(self, frame: Frame) -> MovementSettings:
        return MovementSettings(self._sensitivity, frame.time, frame.camera, tuple(frame.pose_in_robot))

    def _on_result(self, frame: Frame, found: list[MovingCluster] | None) -> None:
        if found:
            clusters = [
                [[c.alpha, c.beta], [*c.corner, *c.size], [c.share_of_picture, c.share_of_rectangle]] for c in found
            ]
            self._memory.insert(INFO, in_picture(frame, clusters, frame.camera))
            self._memory.raise_event(DETECTED, None)
        elif found is not None:
            self._memory.raise_event(NONE, None)
