"""NaoGetUp-v0: get on the feet from the back or the belly."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.envs.base import NaoEnv, legs_of

HIGH = 0.30
"""Height of the torso from which on the robot stands, m."""


class NaoGetUpEnv(NaoEnv):
    """Get up from lying on the back.

    Action (23): all joints but hands and the right hip yaw, which turns with the left. Reward of a step: the height of
    the torso in units of 0.33 m, times how upright it is (0 upside down, 1 upright), and 1 more when it stands. An
    episode never fails, and is over after 10 s.
    """

    POSTURE = "LyingBack"
    JOINTS = (
        "HeadYaw",
        "HeadPitch",
        *legs_of("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw"),
        "LHipYawPitch",
        *legs_of("HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll"),
    )
    REACH = 2.0

    def judge(self, action: np.ndarray) -> tuple[float, bool]:
        height = self.sim.snapshot.torso.position[2]
        upright = (1.0 + np.cos(self.sim.lean)) / 2.0
        return height / 0.33 * upright + float(height > HIGH and upright > 0.95), False
