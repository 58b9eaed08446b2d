"""The way of the centre of mass to a place over the feet, and how the legs stand at its end. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.control.whole_body.body_kinematics import BodyKinematics
from nao_sim_bridge.control.whole_body.cartesian_move import moving_joints
from nao_sim_bridge.control.whole_body.footholds import Footholds
from nao_sim_bridge.control.whole_body.grounded_pose import TORSO, GroundedPose
from nao_sim_bridge.control.whole_body.inverse_kinematics import ALL_AXES, Goal, solve
from nao_sim_bridge.model.frames import FEET

# The centre of mass starts and stops with at most this acceleration, m/s2: more would tip the robot over.
ACCELERATION = 0.5
# The end is looked for in rounds, as the legs are part of the mass that they shift.
ROUNDS, ITERATIONS = 2, 6
# Rounds end when one misses the place by this much, m.
HOPELESS = 0.03
# A place that the search comes no closer to than this, m, is out of reach; the way itself corrects less than that.
REACHABLE = 0.015
# A leg is stretched at most to this share of its length.
STRETCH = 0.98
# The search begins with legs like these, rad: out of a stretched or folded knee it would find no way.
BENT = {"HipRoll": 0.0, "HipPitch": -0.4, "KneePitch": 0.7, "AnklePitch": -0.3, "AnkleRoll": 0.0}
# What the torso keeps: all but its heading, which follows from the feet; if that is too much, neither its height.
KEPT = (ALL_AXES & ~32, ALL_AXES & ~(32 | 4))


@dataclass(eq=False)
class ComPath:
    """The centre of mass on its way.

    Attributes:
        start: (2,) in the frame of the ground, m.
        target: (2,) in the frame of the ground, m.
        posture: (26,) angles at the start, rad.
        guide: (26,) about the angles at the end, rad.
        duration: How long it takes, s.
    """

    start: np.ndarray
    target: np.ndarray
    posture: np.ndarray
    guide: np.ndarray
    duration: float
    _elapsed: float = 0.0

    def advance(self, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """(2,) place `dt` seconds later, m, and (26,) posture then, rad."""
        self._elapsed += dt
        share = SmoothCurve((0.0, self.duration), (0.0, 1.0)).value(self._elapsed)
        return (
            self.start + share * (self.target - self.start),
            self.posture + share * (self.guide - self.posture),
        )


def plan_com_path(
    body: BodyKinematics, now: GroundedPose, feet: Footholds, target: np.ndarray, duration: float
) -> ComPath | None:
    """The way to (2,) `target` m, in `duration` s or as it needs; None when the legs do not reach so far."""
    start = now.center_of_mass()[:2]
    guides = (_legs_at(body, now, feet, target, mask) for mask in KEPT)
    guide = next((found for found in guides if found is not None), None)
    if guide is None:
        return None
    # The peak acceleration of a smooth curve from rest to rest is 6 distances over the square of its duration.
    least = math.sqrt(6.0 * float(np.linalg.norm(target - start)) / ACCELERATION)
    return ComPath(start, target, now.body.angles.copy(), guide, max(duration, least))


def _legs_at(
    body: BodyKinematics, now: GroundedPose, feet: Footholds, target: np.ndarray, mask: int
) -> np.ndarray | None:
    """(26,) angles in rad with the centre of mass about at `target`, and the torso as it is now but for the shift."""
    legs = moving_joints(body.model, FEET)
    angles = now.body.angles.copy()
    for side in "LR":
        for name, angle in BENT.items():
            angles[body.row[side + name]] = angle
    shift = target - now.center_of_mass()[:2]
    for _ in range(ROUNDS):
        torso = now.torso.copy()
        torso[:3, 3] += (*shift, -_drop(body, now, shift))
        goals = [*feet.kept, Goal(TORSO, torso, mask)]
        angles = solve(body, legs, goals, angles, feet.footing, ITERATIONS)
        missing = target - GroundedPose(body.at(angles), feet.footing).center_of_mass()[:2]
        shift = shift + missing
        if float(np.linalg.norm(missing)) > HOPELESS:
            break
    return angles if float(np.linalg.norm(missing)) < REACHABLE else None


def _drop(body: BodyKinematics, now: GroundedPose, shift: np.ndarray) -> float:
    """How much lower, m, the torso must be when it is shifted by (2,) `shift`, so that no leg is stretched."""
    thigh, shank = (body.origins[body.row[name]] for name in ("LKneePitch", "LAnklePitch"))
    reach = STRETCH * float(np.linalg.norm(thigh) + np.linalg.norm(shank))
    lowest = 0.0
    for side in "LR":
        hip, ankle = (now.torso @ now.body.poses[body.row[side + name]] for name in ("HipRoll", "AnkleRoll"))
        away = hip[:3, 3] - ankle[:3, 3]
        aside = float(np.linalg.norm(away[:2] + shift))
        lowest = max(lowest, away[2] - math.sqrt(max(reach**2 - aside**2, 0.0)))
    return lowest
