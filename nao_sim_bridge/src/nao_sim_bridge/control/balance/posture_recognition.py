"""Which posture the robot is in, from what it measures itself: joint angles, lean of the torso, load on the feet.

The *family* is decided by geometry (which way the torso faces, how high the hips are over the soles, whether the feet
carry the robot), so it is known for any joint angles. The *posture* is the predefined one of that family whose joints
are all near.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

import numpy as np

from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.kinematics import link_transforms
from nao_sim_bridge.model.postures import load_postures, posture
from nao_sim_bridge.model.robot_model import RobotModel

STANDING, CROUCHING, SITTING, ON_CHAIR = "Standing", "Crouching", "Sitting", "SittingOnChair"
BELLY, BACK, LEFT, RIGHT = "LyingBelly", "LyingBack", "LyingLeft", "LyingRight"
LYING_FAMILIES = (BELLY, BACK, LEFT, RIGHT)
FAMILIES = (STANDING, CROUCHING, SITTING, ON_CHAIR, *LYING_FAMILIES)
UNKNOWN = "Unknown"

# A torso that leans more than this (rad) lies on one of its four sides.
LYING = math.radians(50.0)
# On its feet the robot leans at most this, rad: beyond, it is falling.
STANDING_LEAN = math.radians(35.0)
# A sole within this of the horizontal (rad) stands flat on the floor.
FLAT = math.radians(20.0)
# Height of the hips over the lower sole, m. Straight legs have 0.25, legs ready to walk 0.23, a crouch 0.14; on its
# seat the robot has 0.09 and less.
STANDING_HIPS, CROUCHING_HIPS = 0.19, 0.115
# Share of its weight that a robot on its feet has on them at least; a chair leaves them little more than the legs.
CARRYING = 0.6
# Below this share the feet are in the air: somebody holds the robot up.
TOUCHING = 0.1
# How far each joint may be from a predefined posture, rad. The nearest two postures of one family are 0.7 apart. The
# floor pushes the legs of one who lies out of their angles, whatever their motors do; no two postures share a side.
TOLERANCE, LYING_TOLERANCE = 0.3, 0.6
# What has not changed by more since a look is the same body: rad, and N over 1000.
SAME, SAME_PER_N = 0.003, 0.001
# Where the robot looks and what it does with its hands make no posture.
LEFT_OUT = ("Head", "Wrist", "Hand")


@dataclass(frozen=True)
class Recognition:
    """What the robot takes its posture for.

    Attributes:
        posture: Name of a predefined posture, or "Unknown".
        family: One of `FAMILIES`, or "Unknown".
    """

    posture: str
    family: str


def recognise(model: RobotModel, snapshot: Snapshot) -> Recognition:
    roll, pitch, _ = snapshot.imu.angles
    load = (snapshot.left_foot.total + snapshot.right_foot.total) / (model.total_mass * 9.81)
    return recognise_readings(model, snapshot.positions, roll, pitch, load)


class PostureWatch:
    """Recognises again and again, which costs nothing while the body stays as it was recognised."""

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._readings: Sequence[float] = ()
        self._seen = Recognition(UNKNOWN, UNKNOWN)

    def recognise(self, snapshot: Snapshot) -> Recognition:
        load = snapshot.left_foot.total + snapshot.right_foot.total
        readings = (*snapshot.positions, *snapshot.imu.angles[:2], load * SAME_PER_N)
        moved = [abs(now - then) for now, then in zip(readings, self._readings)]
        if not moved or max(moved) > SAME:
            self._readings, self._seen = readings, recognise(self._model, snapshot)
        return self._seen


def recognise_readings(
    model: RobotModel, angles: Sequence[float], roll: float, pitch: float, load: float
) -> Recognition:
    """Posture and family that readings speak of.

    Args:
        angles: (26,) measured joint angles in Body order, rad.
        roll: Of the torso in world, rad.
        pitch: Of the torso in world, rad.
        load: Share of the robot's weight on its feet.
    """
    family = family_of(model, angles, roll, pitch, load)
    return Recognition(nearest_posture(model, angles, family), family)


def family_of(model: RobotModel, angles: Sequence[float], roll: float, pitch: float, load: float) -> str:
    """The family alone; arguments as in `recognise_readings`."""
    up = up_in_torso(roll, pitch)
    lean = lean_of(roll, pitch)
    if lean > LYING:
        forward, left = up[0], up[1]
        if abs(forward) >= abs(left):
            return BACK if forward > 0.0 else BELLY
        return RIGHT if left > 0.0 else LEFT
    hips, flat = _hips_over_soles(model, angles, np.array(up))
    if hips < CROUCHING_HIPS:
        return SITTING
    if not flat or lean > STANDING_LEAN or load < TOUCHING:
        return UNKNOWN
    if load < CARRYING:
        # Half the weight on straight legs is a robot that was pushed; half of it on bent legs, one that sits.
        return STANDING if hips > STANDING_HIPS else ON_CHAIR
    return STANDING if hips > STANDING_HIPS else CROUCHING


def nearest_posture(model: RobotModel, angles: Sequence[float], family: str) -> str:
    """The predefined posture of a family that all joints are near, "Unknown" when there is none."""
    compared = [i for i, joint in enumerate(model.joints) if not any(part in joint.name for part in LEFT_OUT)]
    best, least = UNKNOWN, LYING_TOLERANCE if family in LYING_FAMILIES else TOLERANCE
    for name, entry in load_postures().by_name.items():
        if entry.family != family:
            continue
        goal = posture(model, name)
        worst = max(abs(angles[i] - goal[i]) for i in compared)
        if worst < least:
            best, least = name, worst
    return best


def up_in_torso(roll: float, pitch: float) -> Vector3:
    """The direction against gravity in the frame of a torso with this roll and pitch, rad; a unit vector."""
    return (-math.sin(pitch), math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll))


def lean_of(roll: float, pitch: float) -> float:
    """Angle of the torso to the vertical, rad, 0 to pi."""
    return math.acos(max(-1.0, min(1.0, up_in_torso(roll, pitch)[2])))


def _hips_over_soles(model: RobotModel, angles: Sequence[float], up: np.ndarray) -> tuple[float, bool]:
    """Height of the hips over the lower foot, m, and whether that foot is flat."""
    links = link_transforms(model, angles)
    hips = sum(float(up @ links[f"{side}HipPitch"][:3, 3]) for side in "LR") / 2.0
    feet = [links[f"{side}AnkleRoll"] for side in "LR"]
    # The tip of a foot on edge is no sole: heights are those of the middle of the sole.
    heights = [float(up @ (foot[:3, 3] - model.sole_height * foot[:3, 2])) for foot in feet]
    lower = min(range(2), key=heights.__getitem__)
    return hips - heights[lower], float(up @ feet[lower][:3, 2]) > math.cos(FLAT)
