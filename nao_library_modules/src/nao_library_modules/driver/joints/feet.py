"""Where the soles are below the torso, and the footprint between them (REP 120). Pure functions.

Lengths and axes: published kinematics of the NAO, the same in V3 to V6.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Tuple

from ...base.rotations import Quaternion, Vector, about, from_roll_pitch_yaw, inverse, product, rotate

HIP_Y, HIP_Z = 0.05, 0.085
THIGH, TIBIA, FOOT = 0.1, 0.1029, 0.04519
"""m: hip in the torso frame, lengths of thigh and tibia, height of the ankle above the sole."""
X, Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
_TILTED = math.sqrt(0.5)
LEG = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
LEG_JOINTS = {side: tuple(side + joint for joint in LEG) for side in ("L", "R")}

Pose = Tuple[Vector, Quaternion]


def sole(side: str, angles: Sequence[float]) -> tuple[Vector, Vector]:
    """Place of a sole and its toes' direction in the torso frame, from the angles of a leg (L or R), hip first, rad."""
    outwards = 1.0 if side == "L" else -1.0
    place: Vector = (0.0, 0.0, -FOOT)
    toes: Vector = X
    # From the ankle up: each joint turns all that hangs on it.
    axes = ((0.0, _TILTED, -_TILTED * outwards), X, Y, Y, Y, X)
    lengths = (0.0, 0.0, 0.0, THIGH, TIBIA, 0.0)
    for axis, angle, length in reversed(list(zip(axes, angles, lengths))):
        turn = about(axis, angle)
        x, y, z = rotate(turn, place)
        place, toes = (x, y, z - length), rotate(turn, toes)
    return (place[0], place[1] + HIP_Y * outwards, place[2] - HIP_Z), toes


def footprint(angles: Mapping[str, float], roll: float, pitch: float) -> Pose:
    """The frame base_footprint in the torso frame: between the soles, level, on the ground, heading like the feet.

    Joint angles are those measured, roll and pitch those of the torso, all in rad.

    Raises KeyError if a joint of the legs is missing, as on a robot without legs.
    """
    tilt = from_roll_pitch_yaw(roll, pitch, 0.0)
    feet = [sole(side, [angles[joint] for joint in joints]) for side, joints in LEG_JOINTS.items()]
    (left, left_toes), (right, right_toes) = ((rotate(tilt, place), rotate(tilt, toes)) for place, toes in feet)
    middle = ((left[0] + right[0]) / 2, (left[1] + right[1]) / 2, min(left[2], right[2]))
    heading = math.atan2(left_toes[1] + right_toes[1], left_toes[0] + right_toes[0])
    back = inverse(tilt)
    return rotate(back, middle), product(back, from_roll_pitch_yaw(0.0, 0.0, heading))
