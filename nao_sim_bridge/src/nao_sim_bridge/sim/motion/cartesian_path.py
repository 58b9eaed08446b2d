"""Paths of an effector through poses, as curves of its joints. Pure."""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np

from nao_sim_bridge.sim.frames import Frame
from nao_sim_bridge.sim.kinematics import axis_matrix, transform
from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.motion.curves import SmoothCurve
from nao_sim_bridge.sim.motion.inverse_kinematics import rotation_vector, solve

# Joint curves pass through an exact solution this often, s; between them they deviate by less than a motor does. Long
# paths have fewer, so that starting one does not delay a tick by much.
SAMPLE_TIME = 0.1
MAX_SAMPLES = 24


class PosePath:
    """A smooth path through poses, at rest at both ends.

    Args:
        times: Times of the poses, s, the first is 0.
        poses: (4, 4) each, in one frame.
    """

    def __init__(self, times: Sequence[float], poses: Sequence[np.ndarray]) -> None:
        self._start = poses[0][:3, :3]
        turns = [rotation_vector(self._start.T @ pose[:3, :3]) for pose in poses]
        points = [(*pose[:3, 3], *turn) for pose, turn in zip(poses, turns)]
        self._curves = [SmoothCurve(tuple(times), tuple(float(v) for v in values)) for values in zip(*points)]

    def pose(self, elapsed: float) -> np.ndarray:
        """(4, 4) pose after `elapsed` seconds."""
        values = [curve.value(elapsed) for curve in self._curves]
        angle = math.sqrt(sum(v * v for v in values[3:]))
        turn = axis_matrix([v / angle for v in values[3:]], angle) if angle > 0.0 else np.eye(3)
        return transform(self._start @ turn, values[:3])


def sample_times(times: Sequence[float]) -> list[float]:
    """Rising times in s from `times[0]` = 0 to the end: every key time, and steps between them."""
    step = max(SAMPLE_TIME, times[-1] / MAX_SAMPLES)
    found = [0.0]
    for start, end in zip(times, times[1:]):
        count = max(1, math.ceil((end - start) / step))
        found += [start + (end - start) * k / count for k in range(1, count)] + [end]
    return found


def joint_curves(
    model: RobotModel,
    indices: Sequence[int],
    frame: Frame,
    path: PosePath,
    times: Sequence[float],
    mask: int,
    space: np.ndarray,
    commands: Sequence[float],
) -> dict[int, SmoothCurve]:
    """Curves of joints that move `frame` along a path.

    Args:
        model: The robot.
        indices: Joints from the torso to `frame`, without hands.
        frame: What moves.
        path: Poses in the space.
        times: Key times of the path, s, the first is 0.
        mask: Axes that count, as in `solve`.
        space: (4, 4) pose of the space in the torso frame.
        commands: (26,) angles to begin at, rad.
    """
    at = sample_times(times)
    angles = list(commands)
    solved = [[angles[i] for i in indices]]
    for moment in at[1:]:
        solution = solve(model, indices, frame, space @ path.pose(moment), mask, space[:3, :3], angles)
        for index, angle in zip(indices, solution):
            angles[index] = angle
        solved.append(solution)
    return {index: SmoothCurve(tuple(at), values) for index, values in zip(indices, zip(*solved))}
