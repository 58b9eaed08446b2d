"""The walking body: where its centre of mass, its feet and the robot are, by angles told or measured."""

from __future__ import annotations

from math import atan2
from typing import Sequence, Tuple

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import rotate
from nao_sim_bridge.control.balance.stance import FEET, MassCarrier, limb_tips
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.walk.footsteps import FootPose, middle
from nao_sim_bridge.walk.legs import LEFT, RIGHT, LegAngles, Legs
from nao_sim_bridge.walk.matrices import Matrix, Vector

# HipYawPitch, left leg, right leg: rad.
LegPose = Tuple[float, LegAngles, LegAngles]


class WalkingBody:
    """Legs, and whatever is above them; `mass` is that of the robot, kg."""

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
        """Of the whole robot in the torso frame, m, and ankle place and foot rotation of the left and right leg."""
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


def foot_on_ground(body: WalkingBody, torso: Pose, angles: Sequence[float], side: int) -> FootPose:
    """A foot in the world that the torso's pose is in; (26,) joint angles in rad."""
    hip, left, right = body.leg_pose(angles)
    _, ankle, foot = body.legs.state(side, hip, left if side == LEFT else right)
    height = body.legs.sole_height
    below = (ankle[0] - height * foot[2], ankle[1] - height * foot[5], ankle[2] - height * foot[8])
    x, y, _ = rotate(torso.orientation, below)
    ahead = rotate(torso.orientation, (foot[0], foot[3], foot[6]))
    return FootPose(torso.position[0] + x, torso.position[1] + y, atan2(ahead[1], ahead[0]))


def robot_on_ground(body: WalkingBody, torso: Pose, angles: Sequence[float]) -> FootPose:
    """The robot, half way between its feet."""
    return middle(foot_on_ground(body, torso, angles, LEFT), foot_on_ground(body, torso, angles, RIGHT))


def frame_from(there: FootPose, here: FootPose) -> FootPose:
    """Where a frame lies in the world in which something is `there`, when it is `here` in the frame."""
    origin = FootPose(0.0, 0.0, 0.0).seen_from(here)
    return there.moved(*origin)
