"""Where the robot and its feet are on the ground, from the pose of the torso and the angles of the legs."""

from __future__ import annotations

from math import atan2
from typing import Sequence

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import rotate
from nao_sim_bridge.walk.body import WalkingBody
from nao_sim_bridge.walk.footsteps import FootPose, middle
from nao_sim_bridge.walk.legs import LEFT, RIGHT


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
