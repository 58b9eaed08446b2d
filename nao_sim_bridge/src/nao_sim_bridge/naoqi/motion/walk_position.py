"""Part of ALMotion: where the robot is in its world, where it will be, and how fast it goes."""

from __future__ import annotations

from typing import Callable, Iterable

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.motion.part import MotionPart
from nao_sim_bridge.walk.locomotion import Locomotion


class WalkPosition(MotionPart):
    """Poses [x, y, theta] and velocities of the robot on the ground, in FRAME_WORLD."""

    def getRobotPosition(self, use_sensors: bool) -> Task:
        return self._read("getRobotPosition", lambda locomotion: locomotion.position(bool(use_sensors)))

    def getNextRobotPosition(self) -> Task:
        return self._read("getNextRobotPosition", lambda locomotion: locomotion.next_position())

    def getRobotVelocity(self) -> Task:
        return self._read("getRobotVelocity", lambda locomotion: locomotion.velocity())

    def _read(self, call: str, reading: Callable[[Locomotion], Iterable[float]]) -> Task:
        # Between two ticks: plan, commands and sensors are of one moment there.
        return self._runner.execute(lambda: list(reading(self._robot.locomotion)), call)
