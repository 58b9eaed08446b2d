"""Rotations as matrices, and where all links are for given joint angles. Pure functions of arrays."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Dict

import numpy as np

from nao_sim_bridge.model.robot_model import RobotModel


def rpy_matrix(rpy: Sequence[float]) -> np.ndarray:
    """(3, 3) rotation Rz(yaw) Ry(pitch) Rx(roll); angles in rad."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(rpy), np.cos(rpy)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def matrix_rpy(rotation: np.ndarray) -> tuple[float, float, float]:
    """Roll, pitch, yaw in rad of a (3, 3) rotation; at pitch +-90 degrees the roll is taken as zero."""
    pitch = math.asin(max(-1.0, min(1.0, -rotation[2, 0])))
    if abs(rotation[2, 0]) > 1.0 - 1e-9:
        return 0.0, pitch, math.atan2(-rotation[0, 1], rotation[1, 1])
    roll = math.atan2(rotation[2, 1], rotation[2, 2])
    return roll, pitch, math.atan2(rotation[1, 0], rotation[0, 0])


def axis_matrix(axis: Sequence[float], angle: float) -> np.ndarray:
    """(3, 3) rotation by `angle` rad about a unit vector."""
    x, y, z = axis
    s, c = math.sin(angle), math.cos(angle)
    k = 1.0 - c
    return np.array(
        [
            [c + x * x * k, x * y * k - z * s, x * z * k + y * s],
            [y * x * k + z * s, c + y * y * k, y * z * k - x * s],
            [z * x * k - y * s, z * y * k + x * s, c + z * z * k],
        ]
    )


def quaternion_matrix(quaternion: Sequence[float]) -> np.ndarray:
    """(3, 3) rotation of a unit quaternion (x, y, z, w)."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def matrix_quaternion(rotation: np.ndarray) -> tuple[float, float, float, float]:
    """Unit quaternion (x, y, z, w) of a (3, 3) rotation."""
    m = rotation
    candidates = (
        1.0 + m[0, 0] - m[1, 1] - m[2, 2],
        1.0 - m[0, 0] + m[1, 1] - m[2, 2],
        1.0 - m[0, 0] - m[1, 1] + m[2, 2],
        1.0 + m[0, 0] + m[1, 1] + m[2, 2],
    )
    # The largest component is the safe divisor.
    largest = max(range(4), key=candidates.__getitem__)
    twice = math.sqrt(candidates[largest])
    if largest == 3:
        parts = (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], candidates[3])
    elif largest == 0:
        parts = (candidates[0], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2])
    elif largest == 1:
        parts = (m[0, 1] + m[1, 0], candidates[1], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0])
    else:
        parts = (m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], candidates[2], m[1, 0] - m[0, 1])
    x, y, z, w = (float(part) / (2.0 * twice) for part in parts)
    return x, y, z, w


def transform(rotation: np.ndarray, position: Sequence[float]) -> np.ndarray:
    """(4, 4) homogeneous transform."""
    result = np.eye(4)
    result[:3, :3] = rotation
    result[:3, 3] = position
    return result


def link_transforms(model: RobotModel, angles: Sequence[float]) -> dict[str, np.ndarray]:
    """Link name to (4, 4) pose in the torso frame, for (26,) angles in Body order, rad; hands do not matter."""
    poses = {"Torso": np.eye(4)}
    for joint, angle in zip(model.joints, angles):
        if joint.child_link is not None:
            step = transform(axis_matrix(joint.axis, float(angle)), joint.origin)
            poses[joint.child_link] = poses[joint.parent_link] @ step
    return poses


class LinkPoses(Dict[str, np.ndarray]):
    """As `link_transforms`, each pose worked out when it is asked for; to be looked up, not gone through."""

    def __init__(self, model: RobotModel, angles: Sequence[float]) -> None:
        super().__init__(Torso=np.eye(4))
        self._model = model
        self._angles = angles

    def __missing__(self, link: str) -> np.ndarray:
        for joint, angle in zip(self._model.joints, self._angles):
            if joint.child_link == link:
                step = transform(axis_matrix(joint.axis, float(angle)), joint.origin)
                pose = self[link] = self[joint.parent_link] @ step
                return pose
        raise KeyError(link)


def finger_transforms(model: RobotModel, opening: float) -> dict[str, np.ndarray]:
    """Phalanx name (`Finger11`) to (4, 4) pose in the frame of the wrist link; `opening` is 0 closed to 1 open."""
    poses = {}
    for finger in model.fingers:
        bend = transform(axis_matrix(finger.axis, (opening - 1.0) * finger.travel), (0.0, 0.0, 0.0))
        pose = transform(rpy_matrix(finger.base.rpy), finger.base.position) @ bend
        for phalanx in finger.phalanges:
            poses[phalanx] = pose
            pose = pose @ transform(np.eye(3), (finger.length, 0.0, 0.0)) @ bend
    return poses
