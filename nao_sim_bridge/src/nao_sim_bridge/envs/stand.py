"""NaoStand-v0: stay on the feet while somebody pushes."""

from __future__ import annotations

from typing import Any

import numpy as np

from nao_sim_bridge.envs.base import ARMS, LEGS, NaoEnv, Randomization


class NaoStandEnv(NaoEnv):
    """Stand, with pushes of up to 3 N s every two seconds if nobody says otherwise.

    Action (14): hips, knees, ankles and shoulders. Reward of a step: 1, less the lean of the torso (1 minus its cosine,
    times 2), less what the joints are off the posture and how fast the action changes. An episode fails when the robot
    has fallen, and is over after 10 s.
    """

    JOINTS = (*LEGS, *ARMS)

    def __init__(
        self, render_mode: str | None = None, randomization: Any = None, drive: str = "position", **options: Any
    ) -> None:
        pushes = Randomization(push=3.0) if randomization is None else randomization
        super().__init__(render_mode, pushes, drive, **options)

    def judge(self, action: np.ndarray) -> tuple[float, bool]:
        change = float(np.square(action - self.last_action).mean())
        effort = float(np.square(action).mean())
        return 1.0 - 2.0 * (1.0 - np.cos(self.sim.lean)) - 0.1 * effort - 0.1 * change, self.sim.fallen
