"""ALRobotPose of the simulated robot, the module that ALRobotPosture has replaced: coarse poses and since when."""

from __future__ import annotations

from typing import Mapping

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance import posture_recognition as families
from nao_sim_bridge.control.balance.posture_recognition import recognise
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.model.robot_model import RobotModel

NAME = "ALRobotPose"
UNKNOWN = "Unknown"
# The old names of what the robot recognises now.
POSES: Mapping[str, str] = {
    families.STANDING: "Stand",
    families.CROUCHING: "Crouch",
    families.SITTING: "Sit",
    families.ON_CHAIR: "Sit",
    families.BELLY: "Belly",
    families.BACK: "Back",
    families.LEFT: "Left",
    families.RIGHT: "Right",
}
# Poses that the old module knew and that nothing recognises any more.
NEVER = ("Frog", "HeadBack", "Knee")
# s between two looks.
PERIOD = 0.5


class ALRobotPose:
    """ALRobotPose as the simulated robot offers it."""

    def __init__(self, runner: SimulationRunner, watch: PoseWatch) -> None:
        self._runner = runner
        self._watch = watch

    def getActualPoseAndTime(self) -> list:
        pose, since = self._watch.state
        return [pose, max(0.0, self._runner.snapshot.time - since)]

    def getPoseNames(self) -> list[str]:
        return sorted({*POSES.values(), *NEVER, UNKNOWN})


class PoseWatch:
    """Notes when the pose changes; called after every tick, in the simulation thread.

    Attributes:
        state: Pose, and the simulated time in s since which the robot is in it; replaced as a whole.
    """

    def __init__(self, model: RobotModel) -> None:
        self.state = (UNKNOWN, 0.0)
        self._model = model
        self._next = 0.0

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the robot now and then."""
        if snapshot.time < self._next:
            return
        self._next = snapshot.time + PERIOD
        pose = POSES.get(recognise(self._model, snapshot).family, UNKNOWN)
        if pose != self.state[0]:
            self.state = (pose, snapshot.time)
