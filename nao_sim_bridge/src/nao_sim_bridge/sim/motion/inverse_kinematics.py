"""Joint angles that bring a frame of the robot to a pose: damped least squares within the joint limits. Pure.

A target out of reach ends at the closest point that was found.
"""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np

from nao_sim_bridge.sim.frames import Frame
from nao_sim_bridge.sim.kinematics import axis_matrix, transform
from nao_sim_bridge.sim.model import RobotModel

# Damping keeps steps small near singular poses; it costs iterations, not accuracy.
DAMPING = 1e-4
MAX_STEP = 0.3  # rad per iteration
ENOUGH = 1e-5  # m and rad
ITERATIONS = 80
# One radian of wrong orientation weighs as much as this many metres of wrong position: about an arm's length.
RADIAN_AS_METRES = 0.2
WEIGHTS = np.array([1.0] * 3 + [RADIAN_AS_METRES] * 3)


def rotation_vector(rotation: np.ndarray) -> np.ndarray:
    """(3,) axis times angle (rad) of a (3, 3) rotation."""
    twist = np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    sine = np.linalg.norm(twist) / 2.0
    angle = math.atan2(sine, (np.trace(rotation) - 1.0) / 2.0)
    if sine > 1e-9:
        return twist * (angle / (2.0 * sine))
    if angle < 1.0:
        return twist / 2.0
    # Half a turn: the axis is the largest column of R + 1.
    column = max((rotation + np.eye(3)).T, key=lambda c: float(c @ c))
    return column / np.linalg.norm(column) * angle


def solve(
    model: RobotModel,
    indices: Sequence[int],
    frame: Frame,
    target: np.ndarray,
    mask: int,
    axes: np.ndarray,
    start: Sequence[float],
) -> list[float]:
    """Angles of the joints `indices` that bring `frame` closest to `target`.

    Args:
        model: The robot.
        indices: Body indices of the joints from the torso to the link of `frame`, in that order, all without hands.
        frame: What is to be moved.
        target: (4, 4) in the torso frame.
        mask: Which axes count: x 1, y 2, z 4, and the rotations about them 8, 16, 32.
        axes: (3, 3) orientation in the torso frame of the axes that `mask` speaks of.
        start: (26,) angles to begin at, rad.

    Returns:
        One angle for each of `indices`, rad, within the limits.
    """
    joints = [model.joints[i] for i in indices]
    lower, upper = (np.array([getattr(j, side) for j in joints]) for side in ("lower", "upper"))
    rows = [row for row in range(6) if mask >> row & 1]
    best = angles = np.clip([float(start[i]) for i in indices], lower, upper)
    smallest = math.inf
    for _ in range(ITERATIONS):
        pose, jacobian = _pose_and_jacobian(joints, frame, angles)
        error = np.concatenate((target[:3, 3] - pose[:3, 3], rotation_vector(target[:3, :3] @ pose[:3, :3].T)))
        turn = np.kron(np.eye(2), axes.T)
        error = (WEIGHTS * (turn @ error))[rows]
        size = float(np.linalg.norm(error))
        if size < smallest:
            best, smallest = angles, size
        if size < ENOUGH:
            break
        weighted = (WEIGHTS[:, None] * (turn @ jacobian))[rows]
        step = _step_within_limits(weighted, error, angles, lower, upper)
        if np.abs(step).max() < 1e-7:
            break
        angles = np.clip(angles + step, lower, upper)
    return [float(angle) for angle in best]


def _step_within_limits(
    jacobian: np.ndarray, error: np.ndarray, angles: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> np.ndarray:
    """One damped step; a joint at its limit that would leave it stands still, and the others make up for it."""
    jacobian = jacobian.copy()
    step = np.zeros(len(angles))
    for _ in range(len(angles)):
        step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + DAMPING * np.eye(len(error)), error)
        leaving = ((angles <= lower) & (step < 0.0)) | ((angles >= upper) & (step > 0.0))
        if not leaving.any():
            break
        jacobian[:, leaving] = 0.0
    return step / max(1.0, np.abs(step).max() / MAX_STEP)


def _pose_and_jacobian(joints: Sequence, frame: Frame, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    pose = np.eye(4)
    places = []
    for joint, angle in zip(joints, angles):
        pose = pose @ transform(axis_matrix(joint.axis, float(angle)), joint.origin)
        places.append((pose[:3, :3] @ joint.axis, pose[:3, 3]))
    pose = pose @ frame.offset
    columns = [np.concatenate((np.cross(axis, pose[:3, 3] - at), axis)) for axis, at in places]
    return pose, np.array(columns).T
