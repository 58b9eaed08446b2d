"""Where head and arms have to go so that the robot looks or points at a place. Pure functions."""

from __future__ import annotations

import math
from typing import Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.rotations import vector3
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.frames import ROBOT, WORLD, Placement, robot_in_world, space_in_torso
from nao_sim_bridge.model.kinematics import LinkPoses, quaternion_matrix, rpy_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel

Point = Tuple[float, float, float]
HEAD = ("HeadYaw", "HeadPitch")
ARMS = {"LArm": "L", "RArm": "R"}
# A place nearer to the neck or to a shoulder than this, m, has no direction.
NEAREST = 0.08
# An arm that points is straight but for this, rad: its elbow cannot be straighter.
STRAIGHT = 0.04
# Below this length, m, x and y of a place have no direction.
ABOVE = 1e-6


def placement(model: RobotModel, now: Snapshot) -> Placement:
    """Where the links are by the sensors, and the torso in the world of the robot's odometry."""
    torso = transform(quaternion_matrix(now.odometry.orientation), now.odometry.position)
    return Placement(LinkPoses(model, now.positions), torso)


def in_torso(model: RobotModel, placed: Placement, point: Sequence[float], frame: int) -> Point:
    """A place in the frame of the torso, from one of ALMotion's frames, m."""
    return vector3((space_in_torso(model, frame, placed) @ _homogeneous(point))[:3])


def in_frame(model: RobotModel, placed: Placement, point: Sequence[float], frame: int) -> Point:
    """A place of the world in one of ALMotion's frames, m."""
    place = space_in_torso(model, WORLD, placed) @ _homogeneous(point)
    return vector3((np.linalg.inv(space_in_torso(model, frame, placed)) @ place)[:3])


def in_world(model: RobotModel, placed: Placement, point: Sequence[float], frame: int = ROBOT) -> Point:
    """A place in the world of the robot's odometry, from one of ALMotion's frames, m."""
    return vector3((placed.torso_in_world @ space_in_torso(model, frame, placed) @ _homogeneous(point))[:3])


def robot_pose(model: RobotModel, placed: Placement) -> Tuple[float, float, float]:
    """x, y in m and heading in rad of the robot in the world of its odometry."""
    pose = robot_in_world(model, placed)
    return float(pose[0, 3]), float(pose[1, 3]), math.atan2(pose[1, 0], pose[0, 0])


def seen_place(camera: Sequence[float], alpha: float, beta: float, distance: float) -> Point:
    """Where something is that a camera sees, m, in the frame of the camera's pose (m; roll, pitch, yaw in rad).

    It is seen in the picture at alpha, to the left, and beta, downwards, rad, and `distance` m from the camera.
    """
    # Angles of a picture are those of the axes: tangents, not two turns in a row.
    ray = np.array((1.0, math.tan(alpha), -math.tan(beta)))
    place = np.asarray(camera[:3]) + rpy_matrix(camera[3:6]) @ (distance / math.sqrt(ray @ ray) * ray)
    return vector3(place)


def distance_of(size: float, angle: float) -> float:
    """How far something is that is `size` m wide and seen under `angle` rad."""
    return size / (2.0 * math.tan(max(angle, 1e-3) / 2.0))


def head_angles(model: RobotModel, point: Point, camera: int = 0) -> Tuple[float, float]:
    """HeadYaw and HeadPitch, rad within their limits, that bring a place into the middle of a camera's picture.

    The place is in the frame of the torso, m; the camera is 0 top or 1 bottom.
    """
    yaw_joint, pitch_joint = map(model.joint, HEAD)
    neck = yaw_joint.origin + pitch_joint.origin
    mount = model.cameras[camera].place
    x, y, z = (a - b for a, b in zip(point, neck))
    ahead = math.hypot(x, y)
    yaw = math.atan2(y, x) if ahead > ABOVE else 0.0
    down = float(mount.rpy[1])
    # How far the line of sight passes above the neck, whatever the pitch.
    offset = float(mount.position[2]) * math.cos(down) + float(mount.position[0]) * math.sin(down)
    distance = max(math.hypot(ahead, z), NEAREST, 1.01 * abs(offset))
    pitch = math.asin(offset / distance) - math.atan2(z, ahead) - down
    return _limited(yaw_joint, yaw), _limited(pitch_joint, pitch)


def arm_angles(model: RobotModel, arm: str, point: Point) -> dict[str, float]:
    """Angles, rad within limits, of "LArm" or "RArm" that points at a place in the frame of the torso, m."""
    side = ARMS[arm]
    pitch_joint, roll_joint = model.joint(f"{side}ShoulderPitch"), model.joint(f"{side}ShoulderRoll")
    x, y, z = (a - b for a, b in zip(point, pitch_joint.origin))
    ahead = math.hypot(x, z)
    pitch = math.atan2(-z, x) if ahead > ABOVE else 0.0
    sign = 1.0 if side == "L" else -1.0
    return {
        f"{side}ShoulderPitch": _limited(pitch_joint, pitch),
        f"{side}ShoulderRoll": _limited(roll_joint, math.atan2(y, max(ahead, ABOVE))),
        f"{side}ElbowYaw": 0.0,
        f"{side}ElbowRoll": -sign * STRAIGHT,
        f"{side}WristYaw": 0.0,
    }


def turn_to(heading: float, bearing: float) -> float:
    """The shortest turn from a heading to another, rad, in -pi..pi."""
    return math.atan2(math.sin(bearing - heading), math.cos(bearing - heading))


def _limited(joint: object, angle: float) -> float:
    return min(max(angle, joint.lower), joint.upper)


def _homogeneous(point: Sequence[float]) -> np.ndarray:
    return np.array((point[0], point[1], point[2], 1.0))
