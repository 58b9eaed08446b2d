"""Named places of the robot, and the three frames that ALMotion speaks in. Pure functions.

`TORSO` sits in the torso; `ROBOT` is on the ground between the feet, its Z axis vertical and its heading the mean of
the feet's; `WORLD` is where `ROBOT` was at the start, as far as the robot's own odometry knows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.model.kinematics import LinkPoses, axis_matrix, rpy_matrix, transform
from nao_sim_bridge.model.robot_model import Place, RobotModel

TORSO, WORLD, ROBOT = 0, 1, 2
FEET = ("LLeg", "RLeg")
# The fingers' joints have no link of their own: they are where the arms end.
HANDS = {"LHand": "LArm", "RHand": "RArm"}
# Below this, m or rad, feet are equally high.
EVEN = 1e-6


def sensor_places(model: RobotModel) -> dict[str, Place]:
    single = [*model.imu.values(), *(camera.place for camera in model.cameras)]
    groups = (model.fsr, model.sonars, model.touch, model.microphones, model.loudspeakers)
    return {place.name: place for place in [*single, *(place for group in groups for place in group)]}


@dataclass(frozen=True)
class Frame:
    """A frame fixed to a link: its (4, 4) pose in the frame of the link."""

    link: str
    offset: np.ndarray


def frame_of(model: RobotModel, name: str) -> Frame:
    """The frame of an effector, a joint or a sensor; that of a hand is that of its arm.

    Raises:
        UnknownName: The robot has no such place.
    """
    place = model.effectors.get(HANDS.get(name, name)) or sensor_places(model).get(name)
    if place is not None:
        return Frame(place.parent_link, transform(rpy_matrix(place.rpy), place.position))
    if name in (link.name for link in model.links):
        return Frame(name, np.eye(4))
    known = [*model.effectors, *(link.name for link in model.links), *sensor_places(model)]
    raise UnknownName("effector, joint or sensor", name, known)


@dataclass(frozen=True)
class Placement:
    """Where the links are in the torso frame, by name, and where the torso is in the world frame, (4, 4) each."""

    links: Mapping[str, np.ndarray]
    torso_in_world: np.ndarray

    def in_torso(self, frame: Frame) -> np.ndarray:
        """(4, 4) pose of a frame in the torso frame."""
        return self.links[frame.link] @ frame.offset


def commanded(model: RobotModel, commands: Sequence[float], measured: Placement) -> Placement:
    """The placement that `commands` (26, rad) ask for, on the lower foot of the `measured` one."""
    links = LinkPoses(model, commands)
    feet = [frame_of(model, name) for name in FEET]
    heights = [(measured.torso_in_world @ measured.in_torso(foot))[2, 3] for foot in feet]
    foot = feet[1] if heights[1] < heights[0] - EVEN else feet[0]
    foot_in_world = measured.torso_in_world @ measured.in_torso(foot)
    return Placement(links, foot_in_world @ np.linalg.inv(links[foot.link] @ foot.offset))


def robot_in_world(model: RobotModel, placement: Placement) -> np.ndarray:
    """(4, 4) pose of `ROBOT` in `WORLD`."""
    feet = [placement.torso_in_world @ placement.in_torso(frame_of(model, name)) for name in FEET]
    middle = (feet[0][:3, 3] + feet[1][:3, 3]) / 2.0
    middle[2] = min(foot[2, 3] for foot in feet)
    # The sum of the feet's forward axes, so that headings on both sides of 180 degrees have a mean.
    forward = feet[0][:2, 0] + feet[1][:2, 0]
    return transform(axis_matrix((0.0, 0.0, 1.0), math.atan2(forward[1], forward[0])), middle)


def space_in_torso(model: RobotModel, space: int, placement: Placement) -> np.ndarray:
    """(4, 4) pose of frame `TORSO`, `WORLD` or `ROBOT` in the torso frame."""
    if space == TORSO:
        return np.eye(4)
    world_in_torso = np.linalg.inv(placement.torso_in_world)
    return world_in_torso if space == WORLD else world_in_torso @ robot_in_world(model, placement)
