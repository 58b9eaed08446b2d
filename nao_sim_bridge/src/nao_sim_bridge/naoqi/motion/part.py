"""What the parts of ALMotion share."""

from __future__ import annotations

from typing import Any, Callable, Sequence

import numpy as np

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.frames import Placement, commanded, space_in_torso
from nao_sim_bridge.naoqi.motion.arguments import joint_indices, space_of
from nao_sim_bridge.tracking.geometry import placement


class MotionPart:
    """A part of ALMotion; its joints are touched in the simulation thread only."""

    def __init__(self, runner: RobotRunner) -> None:
        self._runner = runner
        self._model = runner.simulation.model

    @property
    def _robot(self) -> SimulatedRobot:
        """The robot of now: a reset makes a new one."""
        return self._runner.simulation.robot

    def _indices(self, names: Any) -> list[int]:
        return joint_indices(names, self._model)

    def _follow(self, name: str, indices: Sequence[int], curves: Callable[[Sequence[float]], dict]) -> Task:
        return self._runner.execute(lambda: self._robot.motion.follow(name, indices, curves), name)

    def _hold_limp(self, indices: Sequence[int]) -> None:
        """Take the measured angles of limp joints as commands: stiffening them must not make them jump."""
        joints = self._robot.joints
        limp = [i for i in indices if joints.stiffnesses[i] == 0.0 and not self._robot.motion.busy([i])]
        joints.hold(self._runner.snapshot.positions, limp)

    def _placement(self, use_sensors: bool, now: Snapshot | None = None) -> Placement:
        """Where the links are measured to be, or commanded to be."""
        now = now or self._runner.snapshot
        measured = placement(self._model, now)
        return measured if use_sensors else commanded(self._model, self._robot.joints.commands, measured)

    def _torso_in(self, space: Any, placed: Placement) -> np.ndarray:
        """(4, 4) pose of FRAME_TORSO in the frame that a caller names by its number."""
        return np.linalg.inv(space_in_torso(self._model, space_of(space), placed))
