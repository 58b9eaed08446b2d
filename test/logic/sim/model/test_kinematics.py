"""Forward kinematics against the check values of the tables; rotations, frames, Jacobians and stances against it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import (
    angular_velocity,
    cross,
    from_roll_pitch_yaw,
    multiply,
    roll_pitch_yaw,
    rotate,
    rotate_back,
)
from nao_sim_bridge.control.balance.stance import StanceReader
from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.control.whole_body.grounded_pose import Footing, GroundedPose
from nao_sim_bridge.core.things import Glide, slerp
from nao_sim_bridge.model.body_mass import center_of_links
from nao_sim_bridge.model.frames import frame_of
from nao_sim_bridge.model.kinematics import (
    LinkPoses,
    axis_matrix,
    finger_transforms,
    link_transforms,
    matrix_quaternion,
    matrix_rpy,
    quaternion_matrix,
    rpy_matrix,
)
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture

CHECKS = read_json(config_file("nao_h25.json"))["fk_check_zero_posture_torso_frame"]["positions_m"]
MODEL = load_model()
BODY, STANCES = body_kinematics(MODEL), StanceReader(MODEL)
ZERO = (0.0,) * 26
UPRIGHT, HALF = (0.0, 0.0, 0.0, 1.0), math.sqrt(0.5)
ANGLE = st.floats(-3.1, 3.1)
RPY = st.tuples(ANGLE, st.floats(-1.57, 1.57), ANGLE)


def test_the_zero_posture_meets_the_published_positions():
    poses = link_transforms(MODEL, ZERO)
    for name, expected in CHECKS.items():
        if name == "CoM_V60":
            found = center_of_links(MODEL, MODEL.links, ZERO)
        elif name.endswith("_effector"):
            place = MODEL.effectors[name[: -len("_effector")]]
            found = (poses[place.parent_link] @ np.append(place.position, 1.0))[:3]
        else:
            found = poses[name][:3, 3]
        assert found == pytest.approx(expected, abs=1e-5), name


def test_poses_that_are_worked_out_when_asked_for_are_the_same():
    angles = [0.03 * number for number in range(26)]
    poses = link_transforms(MODEL, angles)
    for first in ("LAnkleRoll", "HeadPitch"):
        asked = LinkPoses(MODEL, angles)
        for link in (first, *poses):
            np.testing.assert_array_equal(asked[link], poses[link])
    with pytest.raises(KeyError):
        LinkPoses(MODEL, angles)["Tail"]


def test_fingers_are_straight_when_open_and_curl_towards_the_thumb():
    straight, closed = finger_transforms(MODEL, 1.0), finger_transforms(MODEL, 0.0)
    assert straight["Finger13"][:3, 3] - straight["Finger11"][:3, 3] == pytest.approx((2 * 0.01436, 0, 0))
    assert closed["Finger13"][2, 3] < straight["Finger13"][2, 3] - 0.01
    assert closed["Thumb2"][2, 3] > straight["Thumb2"][2, 3] + 0.01


@given(RPY, RPY, st.tuples(ANGLE, ANGLE, ANGLE))
@settings(max_examples=50)
def test_rotations_agree_in_every_form(first, second, vector):
    matrix, quaternion = rpy_matrix(first), from_roll_pitch_yaw(*first)
    assert quaternion_matrix(quaternion) == pytest.approx(matrix)
    assert rpy_matrix(matrix_rpy(matrix)) == pytest.approx(matrix)
    assert quaternion_matrix(matrix_quaternion(matrix)) == pytest.approx(matrix)
    assert rpy_matrix(roll_pitch_yaw(quaternion)) == pytest.approx(matrix, abs=1e-6)
    turned = rotate(quaternion, vector)
    assert turned == pytest.approx(tuple(matrix @ vector), abs=1e-9)
    assert rotate_back(quaternion, turned) == pytest.approx(vector, abs=1e-9)
    other = from_roll_pitch_yaw(*second)
    assert rotate(multiply(other, quaternion), vector) == pytest.approx(rotate(other, turned), abs=1e-9)


@pytest.mark.parametrize(
    "quaternion, vector, turned",
    [
        ((0, 0, HALF, HALF), (1, 0, 0), (0, 1, 0)),
        ((HALF, 0, 0, HALF), (0, 1, 0), (0, 0, 1)),
        ((0, HALF, 0, HALF), (0, 0, 1), (1, 0, 0)),
        ((0, 0, 1, 0), (1, 2, 3), (-1, -2, 3)),
    ],
)
def test_rotations_follow_the_right_hand_rule(quaternion, vector, turned):
    assert rotate(quaternion, vector) == pytest.approx(turned)
    assert axis_matrix((0, 0, 1), math.pi / 2) @ (1, 0, 0) == pytest.approx((0, 1, 0))
    assert axis_matrix((0, 1, 0), math.pi / 2) @ (0, 0, 1) == pytest.approx((1, 0, 0))
    assert cross((1, 0, 0), (0, 1, 0)) == (0, 0, 1) and cross((1, 2, 3), (4, 5, 6)) == (-3, 6, -3)


def test_a_way_between_two_poses_is_straight_and_turns_the_short_way_round():
    glide = Glide(Pose((1.0, 0.0, 0.2), UPRIGHT), Pose((1.0, 2.0, 0.2), from_roll_pitch_yaw(0, 0, 1.0)), 10.0, 4.0)
    halfway = glide.at(12.0)
    assert halfway.position == pytest.approx((1.0, 1.0, 0.2))
    assert roll_pitch_yaw(halfway.orientation) == pytest.approx((0.0, 0.0, 0.5))
    assert not glide.ended(13.99) and glide.ended(14.0)
    assert glide.at(9.0) == glide.start and glide.at(14.0) is glide.at(99.0) is glide.target
    for sign in (1.0, -1.0):
        end = tuple(sign * part for part in from_roll_pitch_yaw(0.0, 0.0, -3.0))
        yaw = roll_pitch_yaw(slerp(from_roll_pitch_yaw(0.0, 0.0, 3.0), end, 0.5))[2]
        assert abs(yaw) == pytest.approx(math.pi, abs=1e-6)
    turn = from_roll_pitch_yaw(0.1, 0.2, 0.3)
    assert slerp(turn, turn, 0.5) == pytest.approx(turn)


def test_an_angular_velocity_turns_one_orientation_into_another_the_short_way_round():
    first, axis, angle, seconds = from_roll_pitch_yaw(0.3, -0.4, 1.0), (0.6, 0.0, 0.8), 0.5, 0.25
    turn = (*(math.sin(angle / 2) * part for part in axis), math.cos(angle / 2))
    second = multiply(turn, first)
    for sign in (1.0, -1.0):
        end = tuple(sign * part for part in second)
        assert angular_velocity(first, end, seconds) == pytest.approx((1.2, 0.0, 1.6))
    assert angular_velocity(first, first, seconds) == pytest.approx((0.0, 0.0, 0.0))


SMALL = 1e-6


@pytest.fixture(params=["Stand", "StandInit", "Crouch"])
def angles(request):
    return np.array(posture(MODEL, request.param)) + np.random.default_rng(2).uniform(-0.05, 0.05, 26)


def nudged(angles, joint):
    """`angles` with one motor moved a little: that of the hips moves both."""
    moved = angles.copy()
    moved[[BODY.left_hip, BODY.right_hip] if joint == BODY.left_hip else joint] += SMALL
    return moved


@pytest.mark.parametrize("standing", [None, "LLeg", "RLeg"])
def test_jacobians_say_what_a_small_step_of_a_joint_does(angles, standing):
    foot = standing and frame_of(MODEL, standing)
    footing = standing and Footing(foot, BODY.at(angles * 0.9).pose(foot))
    now = GroundedPose(BODY.at(angles), footing)
    frames = [frame_of(MODEL, name) for name in ("Head", "LArm", "RArm", "LLeg", "RLeg")]
    jacobians, of_mass = [now.jacobian(frame) for frame in frames], now.com_jacobian()
    for joint in np.flatnonzero(BODY.movable):
        then = GroundedPose(BODY.at(nudged(angles, joint)), footing)
        assert (then.center_of_mass() - now.center_of_mass()) / SMALL == pytest.approx(of_mass[:, joint], abs=1e-5)
        for frame, jacobian in zip(frames, jacobians):
            before, after = now.pose(frame), then.pose(frame)
            turn = (after - before)[:3, :3] @ before[:3, :3].T / SMALL
            assert (after - before)[:3, 3] / SMALL == pytest.approx(jacobian[:3, joint], abs=1e-5)
            assert [turn[2, 1], turn[0, 2], turn[1, 0]] == pytest.approx(jacobian[3:, joint], abs=1e-5)
    if standing:
        assert now.pose(foot) == pytest.approx(footing.pose), "a foot that stands does not move"
        assert now.jacobian(foot) == pytest.approx(np.zeros((6, 26)))


@pytest.mark.parametrize("seed", range(3))
def test_stances_agree_with_the_kinematics(seed):
    chance = np.random.default_rng(seed)
    angles, (roll, pitch) = chance.uniform(*MODEL.limits_array().T).tolist(), chance.uniform(-1.0, 1.0, 2).tolist()
    level, links = rpy_matrix((roll, pitch, 0.0)), link_transforms(MODEL, angles)
    stance = STANCES.read(angles, roll, pitch)
    assert stance.com == pytest.approx(level @ center_of_links(MODEL, MODEL.links, angles))
    left, right = (level @ links[f"{side}AnkleRoll"][:3, 3] for side in "LR")
    assert (stance.left_ankle, stance.right_ankle) == (pytest.approx(left), pytest.approx(right))
    assert stance.com_from_feet == pytest.approx(stance.com - (left + right) / 2)
    for side, letter in enumerate("LR"):
        outline = MODEL.sole_polygon(letter)
        corners = np.c_[outline, np.full(len(outline), -MODEL.sole_height), np.ones(len(outline))]
        expected = (level @ (corners @ links[f"{letter}AnkleRoll"].T)[:, :3].T).T
        assert np.array(STANCES.sole(side, angles, roll, pitch)) == pytest.approx(expected)
