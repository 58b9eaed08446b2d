"""NaoWalk-v0: walk at a velocity that is asked for."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from nao_sim_bridge.envs.base import ARMS, LEGS, NaoEnv
from nao_sim_bridge.library.nao import finite_numbers

FASTEST = np.array((0.12, 0.08, 0.5))
"""Velocities that are asked for, at most: ahead and to the left in m/s, to the left in rad/s."""
WIDTH = np.array((0.06, 0.04, 0.25))
"""Errors of velocity at which half of the reward is lost, about."""


class NaoWalkEnv(NaoEnv):
    """Track a velocity command, drawn anew for each episode.

    Action (14): hips, knees, ankles and shoulders. The observation adds the command as shares of its largest values (3)
    and the true velocity of the torso in its own frame in m/s and rad/s (3). Reward of a step: the mean over the three
    of exp(-(error / width)^2), less how fast the action changes. An episode fails when the robot has fallen, and is
    over after 20 s. `options={"command": (x, y, theta)}` of `reset` sets the command.
    """

    JOINTS = (*LEGS, *ARMS)
    REACH = 0.8
    EXTRA = 6
    OPTIONS = ("command",)

    def begin(self, options: Mapping[str, Any]) -> None:
        drawn = self.np_random.uniform(-1.0, 1.0, 3) * FASTEST
        self._command = np.array(finite_numbers("command", options.get("command", drawn), 3))

    def _velocity(self) -> np.ndarray:
        now = self.sim.snapshot
        return np.array((*now.velocity_in_torso[:2], now.turn_in_torso[2]))

    def judge(self, action: np.ndarray) -> tuple[float, bool]:
        errors = (self._velocity() - self._command) / WIDTH
        change = float(np.square(action - self.last_action).mean())
        return float(np.exp(-np.square(errors)).mean()) - 0.05 * change, self.sim.fallen

    def extras(self) -> np.ndarray:
        return np.concatenate((self._command / FASTEST, self._velocity()))
