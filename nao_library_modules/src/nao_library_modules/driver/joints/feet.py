"""Where the soles are below the torso, and the footprint between them (REP 120, nao_description). Pure functions.

Lengths and axes: published kinematics of the NAO, the same in V3 to V6.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Tuple

from ...base.rotations import Quaternion, Vector, about, from_roll_pitch_yaw, inverse, rotate

HIP_Y, HIP_Z = 0.05, 0.085
THIGH, TIBIA, FOOT = 0.1, 0.1029, 0.04519
"""m: hip in the torso frame, lengths of thigh and tibia, height of the ankle above the sole."""
X, Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
_TILTED = math.sqrt(0.5)
LEG = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
LEG_JOINTS = {side: tuple(side + joint for joint in LEG) for side in ("L", "R")}

Pose = Tuple[Vector, Quaternion]


def sole(side: str, angles: Sequence[float]) -> Vector:
    """Place of a sole in the torso frame, m, from the angles of a leg (L or R), hip first, rad."""
    outwards = 1.0 if side == "L" else -1.0
    place: Vector = (0.0, 0.0, -FOOT)
    # From the ankle up: each joint turns all that hangs on it.
    axes = ((0.0, _TILTED, -_TILTED * outwards), X, Y, Y, Y, X)
    lengths = (0.0, 0.0, 0.0, THIGH, TIBIA, 0.0)
    for axis, angle, length in reversed(list(zip(axes, angles, lengths))):
        x, y, z = rotate(about(axis, angle), place)
        place = (x, y, z - length)
    return (place[0], place[1] + HIP_Y * outwards, place[2] - HIP_Z)


def footprint(angles: Mapping[str, float], roll: float, pitch: float) -> Pose:
    """The frame base_footprint in the torso frame: between the soles, level, at the lower one, heading as the torso.

    Joint angles are those measured, roll and pitch those of the torso, all in rad.

    Raises KeyError if a joint of the legs is missing, as on a robot without legs.
    """
    tilt = from_roll_pitch_yaw(roll, pitch, 0.0)
    feet = [sole(side, [angles[joint] for joint in joints]) for side, joints in LEG_JOINTS.items()]
    left, right = (rotate(tilt, place) for place in feet)
    middle = ((left[0] + right[0]) / 2, (left[1] + right[1]) / 2, min(left[2], right[2]))
    back = inverse(tilt)
    return rotate(back, middle), back
