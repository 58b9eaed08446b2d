"""What the robot has seen fills its messages."""

from __future__ import annotations

import math

import pytest
from std_msgs.msg import Header

from nao_library_modules.driver.vision_messages import to_face, to_landmarks, to_movement
from nao_library_modules.driver.vision_values import PARTS, Face, Landmark, Movement, Shape, View
from nao_library_msgs.msg import FaceDetected

VIEW = View(5.0, 1, (0.1, 0.2, 0.3, 0.0, 0.0, math.pi / 2), (0.4, 0.5, 0.6, math.pi, 0.0, 0.0))
HEADER = Header(frame_id="CameraBottom_optical_frame")


def test_every_point_of_a_face_has_its_field():
    names = [f"{part}_{point}" for part, points in PARTS for point in points]
    points = {name: (0.01 * place, -0.01 * place) for place, name in enumerate(names)}
    message = to_face(Face(Shape(0.1, -0.2, 0.15, 0.18), 3, 0.75, "ada", points), VIEW, HEADER)
    for place, name in enumerate(names):
        found = getattr(message, f"{name}_x").data, getattr(message, f"{name}_y").data
        assert found == (0.01 * place, -0.01 * place), name
    fields = {name for name in FaceDetected.__slots__ if name.endswith(("_x", "_y"))}
    assert fields == {f"{name}_{axis}" for name in names for axis in "xy"}
    assert (message.face_id.data, message.score_reco.data, message.face_label.data) == (3, 0.75, "ada")
    assert (message.shape_alpha.data, message.shape_sizeY.data, message.camera_id.data) == (0.1, 0.18, 1)
    assert message.header.frame_id == HEADER.frame_id


def test_poses_are_poses():
    message = to_landmarks([], VIEW, HEADER)
    local, world = message.camera_local_pose, message.camera_world_pose
    assert (local.position.x, local.position.y, local.position.z) == (0.1, 0.2, 0.3)
    assert (local.orientation.z, local.orientation.w) == (pytest.approx(math.sqrt(0.5)), pytest.approx(math.sqrt(0.5)))
    assert (world.orientation.x, world.orientation.w) == (pytest.approx(1.0), pytest.approx(0.0))
    assert message.camera_name.data == "CameraBottom"


def test_landmarks_are_in_one_message():
    marks = [Landmark(Shape(0.1, 0.2, 0.05, 0.06), 84), Landmark(Shape(-0.1, 0.3, 0.07, 0.08), 119)]
    message = to_landmarks(marks, VIEW, HEADER)
    assert [each.data for each in message.mark_ids] == [84, 119]
    assert [each.data for each in message.shape_beta] == [0.2, 0.3]
    assert [each.data for each in message.shape_sizex] == [0.05, 0.07]
    assert [each.data for each in message.shape_sizey] == [0.06, 0.08]


def test_movement_has_a_point_and_a_speed_for_each_part():
    movement = Movement(VIEW, (0.1, 0.2), (0.3, 0.4), ((0.1, 0.2), (0.5, 0.6)), ((0.3, 0.4), (0.7, 0.8)))
    message = to_movement(movement, HEADER)
    assert (message.gravity_center.x, message.gravity_center.y) == (0.1, 0.2)
    assert (message.mean_velocity.x, message.mean_velocity.y) == (0.3, 0.4)
    assert [(each.x, each.y) for each in message.points_poses] == [(0.1, 0.2), (0.5, 0.6)]
    assert [(each.x, each.y) for each in message.points_speeds] == [(0.3, 0.4), (0.7, 0.8)]
