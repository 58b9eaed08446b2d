"""NaoReach-v0: bring the right hand to a point."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.envs.base import NaoEnv
from nao_sim_bridge.library.nao import finite_numbers
from nao_sim_bridge.model.frames import frame_of

NEAR = 0.02
"""m, from which on the hand is there."""
CENTER, WIDE = np.array((0.12, -0.11, 0.10)), np.array((0.06, 0.08, 0.08))
"""Where points are, in the torso's frame: around here, m."""


class NaoReachEnv(NaoEnv):
    """Reach points in front of the right shoulder, standing.

    Action (5): the right arm. The observation adds the point and the hand in the torso's frame in m (6). Reward of a
    step: minus the distance in units of 0.1 m, and 1 while it is below 2 cm. An episode fails when the robot has
    fallen, and is over after 5 s. `options={"point": (x, y, z)}` of `reset` sets the point.
    """

    JOINTS = ("RShoulderPitch", "RShoulderRoll", "RElbowYaw", "RElbowRoll", "RWristYaw")
    REACH = 1.5
    EXTRA = 6
    OPTIONS = ("point",)

    def __init__(self, *arguments, **options) -> None:
        super().__init__(*arguments, **options)
        self._body = body_kinematics(self._model)
        self._frame = frame_of(self._model, "RArm")

    def begin(self, options: Mapping[str, Any]) -> None:
        drawn = CENTER + WIDE * self.np_random.uniform(-1.0, 1.0, 3)
        self._point = np.array(finite_numbers("point", options.get("point", drawn), 3))

    def _hand(self) -> np.ndarray:
        return self._body.at(self.sim.snapshot.positions).pose(self._frame)[:3, 3]

    def judge(self, action: np.ndarray) -> tuple[float, bool]:
        distance = float(np.linalg.norm(self._hand() - self._point))
        return -distance / 0.1 + float(distance < NEAR), self.sim.fallen

    def extras(self) -> np.ndarray:
        return np.concatenate((self._point, self._hand()))
