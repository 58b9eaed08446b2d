"""Where whole body control leads an effector: along a path, or towards a target that may change at any time. Pure."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Callable

import numpy as np

from nao_sim_bridge.control.whole_body.inverse_kinematics import Goal, rotation_vector
from nao_sim_bridge.model.kinematics import axis_matrix, transform

# A new target is approached like a critically damped spring of this frequency does, rad/s: there after about a second.
APPROACH = 6.0
# A target counts as reached, m and rad.
THERE = 1e-5


class PathAim:
    """A goal that follows a path and then stays at its end.

    Attributes:
        goal: Where the effector should be now.
        resting: Whether it does not move any more.

    Args:
        goal: Frame, mask and axes.
        pose_at: Time in s to (4, 4) pose in the frame of the goal.
        duration: Of the path, s.
    """

    def __init__(self, goal: Goal, pose_at: Callable[[float], np.ndarray], duration: float) -> None:
        self._pose_at = pose_at
        self._duration = duration
        self._elapsed = 0.0
        self.goal = replace(goal, pose=pose_at(0.0))
        self.resting = False

    def advance(self, dt: float) -> None:
        """Move on by `dt` seconds."""
        if self.resting:
            return
        self._elapsed = min(self._elapsed + dt, self._duration)
        self.resting = self._elapsed >= self._duration
        self.goal = replace(self.goal, pose=self._pose_at(self._elapsed))


class TargetAim:
    """A goal that moves to a target at limited speed, smoothly also when the target changes.

    Attributes:
        goal: Where the effector should be now.
        target: (4, 4) where it is heading, in the frame of the goal.
        max_speed: m/s, and rad/s of turns.
        resting: Whether it does not move any more.

    Args:
        goal: Where the effector is; frame, mask and axes.
    """

    def __init__(self, goal: Goal, target: np.ndarray, max_speed: tuple[float, float]) -> None:
        self.goal = goal
        self.target = target
        self.max_speed = max_speed
        self.resting = False
        self._velocity = np.zeros(6)

    def aim(self, target: np.ndarray) -> None:
        """Head for another target from now on."""
        self.target, self.resting = target, False

    def advance(self, dt: float) -> None:
        """Move on by `dt` seconds."""
        if self.resting:
            return
        pose = self.goal.pose
        turn = rotation_vector(self.target[:3, :3] @ pose[:3, :3].T)
        away = np.concatenate((self.target[:3, 3] - pose[:3, 3], turn))
        velocity = self._velocity + (APPROACH**2 * away - 2.0 * APPROACH * self._velocity) * dt
        for part, limit in zip((velocity[:3], velocity[3:]), self.max_speed):
            part *= min(1.0, limit / max(math.sqrt(part @ part), 1e-12))
        self._velocity = velocity
        if np.abs(away).max() < THERE and np.abs(velocity).max() < THERE:
            self.goal, self.resting = replace(self.goal, pose=self.target), True
            return
        self.goal = replace(self.goal, pose=_moved(pose, velocity * dt))


def _moved(pose: np.ndarray, step: np.ndarray) -> np.ndarray:
    angle = math.sqrt(step[3:] @ step[3:])
    turn = axis_matrix(step[3:] / angle, angle) if angle > 0.0 else np.eye(3)
    return transform(turn @ pose[:3, :3], pose[:3, 3] + step[:3])
