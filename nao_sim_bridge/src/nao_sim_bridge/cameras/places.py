"""Where the cameras are: truly, for the picture, and where the robot itself believes them to be."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.base.rotations import Quaternion, Vector3
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.cameras.frame import Position6D
from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.cameras.settings import CAMERA_NAMES
from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.model.frames import ROBOT, Placement, frame_of, space_in_torso
from nao_sim_bridge.model.kinematics import matrix_quaternion, matrix_rpy, quaternion_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.world.render_state import RenderState


class CameraPlaces:
    """The cameras of one robot."""

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._body = body_kinematics(model)
        self._frames = [frame_of(model, name) for name in CAMERA_NAMES]
        self.optics = [CameraOptics(model.version, index) for index in range(len(CAMERA_NAMES))]

    def in_world(self, state: RenderState, camera: int) -> tuple[Vector3, Quaternion]:
        """Where a camera truly is."""
        torso = transform(quaternion_matrix(state.base_orientation), state.base_position)
        pose = torso @ self._body.at(state.joint_positions).pose(self._frames[camera])
        x, y, z = (float(value) for value in pose[:3, 3])
        return (x, y, z), matrix_quaternion(pose[:3, :3])

    def measured(self, snapshot: Snapshot, camera: int) -> tuple[Position6D, Position6D]:
        """Where ALMotion says that a camera is, from the sensors: in the torso's frame, and in the robot's."""
        torso = transform(quaternion_matrix(snapshot.odometry.orientation), snapshot.odometry.position)
        poses = self._body.at(snapshot.positions).poses
        placement = Placement({link: poses[row] for link, row in self._body.row.items()}, torso)
        in_torso = placement.in_torso(self._frames[camera])
        robot_in_torso = space_in_torso(self._model, ROBOT, placement)
        return _position6d(in_torso), _position6d(np.linalg.inv(robot_in_torso) @ in_torso)


def _position6d(pose: np.ndarray) -> Position6D:
    x, y, z = (float(value) for value in pose[:3, 3])
    return (x, y, z, *matrix_rpy(pose[:3, :3]))
