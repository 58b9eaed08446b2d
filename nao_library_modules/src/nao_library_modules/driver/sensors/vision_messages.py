"""Detections of the robot's vision modules as messages."""

from __future__ import annotations

from geometry_msgs.msg import Point
from std_msgs.msg import Float32, Header, Int32

from nao_library_msgs.msg import FaceDetected, LandmarkDetected, MovementDetected

from ...nao.camera_facts import CAMERA_NAMES
from ...ros.robot_frames import pose_of
from ...vision.detection.events import DetectionArray
from .vision_values import Face, Movement


def to_face(face: Face, view: DetectionArray, header: Header) -> FaceDetected:
    """A face; points that the robot does not report are 0."""
    message = FaceDetected(header=header)
    message.face_id.data, message.score_reco.data, message.face_label.data = face.number, face.score, face.label
    message.shape_alpha.data, message.shape_beta.data = face.shape.alpha, face.shape.beta
    message.shape_sizeX.data, message.shape_sizeY.data = face.shape.size_x, face.shape.size_y
    for name, (x, y) in face.points.items():
        getattr(message, f"{name}_x").data, getattr(message, f"{name}_y").data = x, y
    message.camera_0_pose, message.camera_1_pose = pose_of(view.in_torso), pose_of(view.in_robot)
    message.camera_id.data = view.camera
    return message


def to_landmarks(seen: DetectionArray, header: Header) -> LandmarkDetected:
    message = LandmarkDetected(header=header)
    message.mark_ids = [Int32(int(mark.name)) for mark in seen.detections]
    message.shape_alpha = [Float32(mark.alpha) for mark in seen.detections]
    message.shape_beta = [Float32(mark.beta) for mark in seen.detections]
    message.shape_sizex = [Float32(mark.size_x) for mark in seen.detections]
    message.shape_sizey = [Float32(mark.size_y) for mark in seen.detections]
    message.camera_local_pose, message.camera_world_pose = pose_of(seen.in_torso), pose_of(seen.in_robot)
    message.camera_name.data = CAMERA_NAMES[seen.camera]
    return message


def to_movement(movement: Movement, header: Header) -> MovementDetected:
    """A movement; angles are x and y of the points, z is 0."""
    return MovementDetected(
        header=header,
        gravity_center=Point(*movement.centre, 0.0),
        mean_velocity=Point(*movement.velocity, 0.0),
        points_poses=[Point(*each, 0.0) for each in movement.points],
        points_speeds=[Point(*each, 0.0) for each in movement.velocities],
    )
