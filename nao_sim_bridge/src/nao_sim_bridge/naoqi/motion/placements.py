"""What Cartesian parts of ALMotion share: the frame argument, and where the links are."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.model.frames import ROBOT, TORSO, WORLD, Placement, commanded
from nao_sim_bridge.model.kinematics import LinkPoses, quaternion_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel


def space_of(value: Any) -> int:
    """The frame that a caller names by its number.

    Raises:
        BadValue: There is no such frame.
    """
    if isinstance(value, bool) or value not in (TORSO, WORLD, ROBOT):
        raise BadValue("space", value, "0 (FRAME_TORSO), 1 (FRAME_WORLD) or 2 (FRAME_ROBOT)")
    return int(value)


def placement(model: RobotModel, robot: SimulatedRobot, now: Snapshot, use_sensors: bool) -> Placement:
    """Where the links are measured to be, or commanded to be."""
    torso = transform(quaternion_matrix(now.odometry.orientation), now.odometry.position)
    measured = Placement(LinkPoses(model, now.positions), torso)
    return measured if use_sensors else commanded(model, robot.joints.commands, measured)
