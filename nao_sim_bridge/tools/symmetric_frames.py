"""Key frames that are the same left and right, as a vector of numbers to search in. Pure."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from nao_sim_bridge.core.posture_moves import PEAK, KeyFrame
from nao_sim_bridge.model.robot_model import RobotModel

# Joints of one side, and whether the angle of the other side is the opposite.
PAIRS = {
    "ShoulderPitch": False,
    "ShoulderRoll": True,
    "ElbowYaw": True,
    "ElbowRoll": True,
    "HipYawPitch": False,
    "HipRoll": True,
    "HipPitch": False,
    "KneePitch": False,
    "AnklePitch": False,
    "AnkleRoll": True,
}
SIZE = len(PAIRS) + 1
SHORTEST, LONGEST = 0.25, 2.0
# Angles that differ by less than this are the same, rad: the limits of both sides do, too.
TOLERANCE = 0.02


def to_vector(model: RobotModel, frames: Sequence[KeyFrame]) -> np.ndarray:
    """(len(frames) * 11,) angles of the left side in rad and the duration in s, frame by frame.

    All frames name every joint of arms and legs; the right side must mirror the left one.
    """
    left = [model.joint_index[f"L{name}"] for name in PAIRS]
    return np.array([[*(frame.angles[i] for i in left), frame.duration] for frame in frames]).ravel()


def to_frames(model: RobotModel, vector: Sequence[float], head: float = 0.0) -> tuple[KeyFrame, ...]:
    """The frames of a vector: within the joint limits, and so long that no motor is asked for more than it can.

    In all of them the head is pitched by `head`, rad.
    """
    frames: list[KeyFrame] = []
    for row in np.asarray(vector, dtype=float).reshape(-1, SIZE):
        angles = {model.joint_index["HeadYaw"]: 0.0, model.joint_index["HeadPitch"]: head}
        for value, (name, opposite) in zip(row, PAIRS.items()):
            for side in "LR":
                index = model.joint_index[side + name]
                joint = model.joints[index]
                wanted = -value if opposite and side == "R" else value
                angles[index] = float(min(max(wanted, joint.lower), joint.upper))
        duration = float(min(max(row[-1], SHORTEST), LONGEST))
        if frames:
            duration = max(duration, least_duration(model, frames[-1], angles))
        frames.append(KeyFrame(duration, angles))
    return tuple(frames)


def least_duration(model: RobotModel, before: KeyFrame, angles: dict[int, float]) -> float:
    """Time that the slowest joint needs from one frame to the next on a smooth curve, s."""
    common = before.angles.keys() & angles.keys()
    return max(PEAK * abs(angles[i] - before.angles[i]) / model.joints[i].max_velocity for i in common)


def mirrored(model: RobotModel, frames: Sequence[KeyFrame]) -> bool:
    """Whether all frames name both arms and legs, the right side as the mirror image of the left one."""
    for frame in frames:
        for name, opposite in PAIRS.items():
            left, right = (frame.angles.get(model.joint_index[side + name]) for side in "LR")
            if left is None or right is None or abs(left + right if opposite else left - right) > TOLERANCE:
                return False
    return True
