"""ALRedBallDetection of the simulated robot."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.sight import Sight
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.ball import Ball
from nao_sim_bridge.vision.client import VisionProcess

NAME, EVENT = "ALRedBallDetection", "redBallDetected"
FPS = 30


class RedBallDetection:
    """Tells where a red ball is, with each picture in which there is one: the one that looks most like a ball.

    The event `redBallDetected` has [[seconds, microseconds], [centre X, centre Y, size X, size Y], pose of the camera
    in FRAME_TORSO, the same in FRAME_ROBOT, index of the camera]; angles in rad from the middle of the picture, X
    positive to the left and Y downwards, sizes are angular radii. When the ball is gone, its value is an empty list,
    and nobody is told. It looks through the camera that ALVideoDevice has active: it has no methods to choose one.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> None:
        self._sight = Sight(memory, EVENT, tell_end=False)
        self.watching = Watching(
            simulation.cameras,
            NAME,
            vision.detector("ball"),
            self._on_result,
            on_stop=self._sight.nothing,
            camera=None,
            fps=FPS,
        )

    def _on_result(self, frame: Frame, found: list[Ball]) -> None:
        if found:
            self._sight.show(ball_value(frame, found[0]))
        else:
            self._sight.nothing()


def ball_value(frame: Frame, ball: Ball) -> list[Any]:
    place = [ball.alpha, ball.beta, ball.radius, ball.radius]
    return [list(frame.stamp), place, list(frame.pose_in_torso), list(frame.pose_in_robot), frame.camera]


def parts(watching: Watching, memory: MemoryStore) -> list[Any]:
    """The objects that together have the methods of ALRedBallDetection: it has just those of all extractors."""
    return [Extractor(NAME, memory, watching.start, watching.stop, [EVENT], changed=watching.changed)]
