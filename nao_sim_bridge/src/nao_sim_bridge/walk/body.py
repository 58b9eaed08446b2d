"""The walking body: where its centre of mass is, by what the joints are told and by what they measure."""

from __future__ import annotations

from typing import Sequence, Tuple

from nao_sim_bridge.control.balance.stance import FEET, MassCarrier, limb_tips
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.walk.legs import LEFT, RIGHT, LegAngles, Legs
from nao_sim_bridge.walk.matrices import Matrix, Vector

# HipYawPitch, left leg, right leg: rad.
LegPose = Tuple[float, LegAngles, LegAngles]


class WalkingBody:
    """Legs, and whatever is above them.

    Attributes:
        legs: Their kinematics.
        mass: Of the robot, kg.
    """

    def __init__(self, model: RobotModel) -> None:
        self.legs = Legs(model)
        self._upper = MassCarrier(model, [tip for tip in limb_tips(model) if tip not in FEET])
        self.mass = self._upper.mass + self.legs.mass
        left, right = self.legs.indices[LEFT], self.legs.indices[RIGHT]
        self._hip, self._left, self._right = left[0], left[1:], right[1:]

    def leg_pose(self, angles: Sequence[float]) -> LegPose:
        """The legs' part of (26,) joint angles, rad."""
        left, right = self._left, self._right
        return (
            angles[self._hip],
            (angles[left[0]], angles[left[1]], angles[left[2]], angles[left[3]], angles[left[4]]),
            (angles[right[0]], angles[right[1]], angles[right[2]], angles[right[3]], angles[right[4]]),
        )

    def upper_moment(self, angles: Sequence[float]) -> Vector:
        """Mass times centre of mass of torso, arms and head in the torso frame, kg m; (26,) angles in rad."""
        return self._upper.moment(angles)

    def center_of_mass(self, upper: Vector, pose: LegPose) -> tuple[Vector, Sequence[tuple[Vector, Matrix]]]:
        """Of the whole robot in the torso frame, m, and ankle place and foot rotation of the left and right leg.

        Args:
            upper: As `upper_moment`.
        """
        hip, left, right = pose
        l_moment, l_ankle, l_foot = self.legs.state(LEFT, hip, left)
        r_moment, r_ankle, r_foot = self.legs.state(RIGHT, hip, right)
        mass = self.mass
        com = (
            (upper[0] + l_moment[0] + r_moment[0]) / mass,
            (upper[1] + l_moment[1] + r_moment[1]) / mass,
            (upper[2] + l_moment[2] + r_moment[2]) / mass,
        )
        return com, ((l_ankle, l_foot), (r_ankle, r_foot))
