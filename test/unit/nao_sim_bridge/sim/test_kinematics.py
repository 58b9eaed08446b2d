"""Forward kinematics against the check values of the tables."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.config import read_json
from nao_sim_bridge.sim.kinematics import (
    axis_matrix,
    center_of_mass,
    finger_transforms,
    link_transforms,
    matrix_quaternion,
    matrix_rpy,
    quaternion_matrix,
    rpy_matrix,
)
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture

CHECKS = read_json(config_file("nao_h25.json"))["fk_check_zero_posture_torso_frame"]["positions_m"]
ZERO = (0.0,) * 26


@pytest.mark.parametrize("name", [name for name in CHECKS if name != "CoM_V60"])
def test_zero_posture_meets_the_published_positions(name):
    model = load_model()
    poses = link_transforms(model, ZERO)
    if name.endswith("_effector"):
        place = model.effectors[name[: -len("_effector")]]
        found = (poses[place.parent_link] @ np.append(place.position, 1.0))[:3]
    else:
        found = poses[name][:3, 3]
    assert found == pytest.approx(CHECKS[name], abs=1e-5)


def test_center_of_mass_at_zero_posture():
    assert center_of_mass(load_model(), ZERO) == pytest.approx(CHECKS["CoM_V60"], abs=1e-5)


def test_turning_the_head_left_moves_the_camera_left():
    model = load_model()
    angles = list(ZERO)
    angles[model.joint_index["HeadYaw"]] = math.pi / 2
    camera = model.cameras[0].place
    position = link_transforms(model, angles)[camera.parent_link] @ np.append(camera.position, 1.0)
    assert position[:3] == pytest.approx((0.0, 0.05871, 0.19014), abs=1e-5)


@pytest.mark.parametrize("name", ["Stand", "StandInit", "Crouch"])
def test_soles_of_standing_postures_are_parallel_and_equally_high(name):
    model = load_model()
    poses = link_transforms(model, posture(model, name))
    left, right = poses["LAnkleRoll"], poses["RAnkleRoll"]
    assert left[:3, :3] @ (0, 0, 1) == pytest.approx(right[:3, :3] @ (0, 0, 1), abs=0.06)
    assert left[2, 3] == pytest.approx(right[2, 3], abs=1e-3)


def test_fingers_are_straight_when_open_and_curl_towards_the_thumb():
    model = load_model()
    straight, closed = finger_transforms(model, 1.0), finger_transforms(model, 0.0)
    assert straight["Finger13"][:3, 3] - straight["Finger11"][:3, 3] == pytest.approx((2 * 0.01436, 0, 0))
    assert closed["Finger13"][2, 3] < straight["Finger13"][2, 3] - 0.01
    assert closed["Thumb2"][2, 3] > straight["Thumb2"][2, 3] + 0.01


@pytest.mark.parametrize("rpy", [(0.3, -0.4, 2.0), (0.0, math.pi / 2, 0.7), (3.0, 1.0, -3.0), (0.0, 0.0, 0.0)])
def test_rotations_survive_the_way_through_other_forms(rpy):
    rotation = rpy_matrix(rpy)
    assert rpy_matrix(matrix_rpy(rotation)) == pytest.approx(rotation)
    assert quaternion_matrix(matrix_quaternion(rotation)) == pytest.approx(rotation)


def test_axis_matrix_turns_by_the_right_hand_rule():
    assert axis_matrix((0, 0, 1), math.pi / 2) @ (1, 0, 0) == pytest.approx((0, 1, 0))
    assert axis_matrix((0, 1, 0), math.pi / 2) @ (0, 0, 1) == pytest.approx((1, 0, 0))
