"""Jacobians against small steps of the joints, poses against plain forward kinematics."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import FEET, frame_of
from nao_sim_bridge.sim.kinematics import center_of_mass, link_transforms
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.body_kinematics import body_kinematics
from nao_sim_bridge.sim.motion.grounded_pose import Footing, GroundedPose
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
BODY = body_kinematics(MODEL)
EFFECTORS = ("Head", "LArm", "RArm", "LLeg", "RLeg")
SMALL = 1e-6


@pytest.fixture(params=["Stand", "StandInit", "Crouch"])
def angles(request):
    generator = np.random.default_rng(2)
    return np.array(posture(MODEL, request.param)) + generator.uniform(-0.05, 0.05, 26)


def nudged(angles, joint):
    """`angles` with one motor moved a little: that of the hips moves both."""
    moved = angles.copy()
    moved[[BODY.left_hip, BODY.right_hip] if joint == BODY.left_hip else joint] += SMALL
    return moved


def test_links_are_where_forward_kinematics_has_them(angles):
    now = BODY.at(angles)
    for name, pose in link_transforms(MODEL, angles).items():
        assert now.poses[BODY.row[name]] == pytest.approx(pose, abs=1e-8)
    assert now.center_of_mass() == pytest.approx(center_of_mass(MODEL, angles), abs=1e-9)


@pytest.mark.parametrize("standing", [None, "LLeg", "RLeg"])
def test_jacobians_say_what_a_small_step_of_a_joint_does(angles, standing):
    foot = standing and frame_of(MODEL, standing)
    footing = standing and Footing(foot, BODY.at(angles * 0.9).pose(foot))
    now = GroundedPose(BODY.at(angles), footing)
    frames = [frame_of(MODEL, name) for name in EFFECTORS]
    jacobians, of_mass = [now.jacobian(frame) for frame in frames], now.com_jacobian()
    for joint in np.flatnonzero(BODY.movable):
        then = GroundedPose(BODY.at(nudged(angles, joint)), footing)
        assert (then.center_of_mass() - now.center_of_mass()) / SMALL == pytest.approx(of_mass[:, joint], abs=1e-5)
        for frame, jacobian in zip(frames, jacobians):
            before, after = now.pose(frame), then.pose(frame)
            turn = (after - before)[:3, :3] @ before[:3, :3].T / SMALL
            assert (after - before)[:3, 3] / SMALL == pytest.approx(jacobian[:3, joint], abs=1e-5)
            assert [turn[2, 1], turn[0, 2], turn[1, 0]] == pytest.approx(jacobian[3:, joint], abs=1e-5)


def test_hands_and_the_right_half_of_the_common_hip_motor_have_no_column(angles):
    jacobian = BODY.at(angles).jacobian(frame_of(MODEL, "RLeg"))
    assert not jacobian[:, ~BODY.movable].any()
    assert jacobian[:, BODY.left_hip].any()


def test_a_foot_that_stands_does_not_move(angles):
    for name in FEET:
        foot = frame_of(MODEL, name)
        footing = Footing(foot, np.eye(4))
        now = GroundedPose(BODY.at(angles), footing)
        assert now.pose(foot) == pytest.approx(np.eye(4))
        assert now.jacobian(foot) == pytest.approx(np.zeros((6, 26)))


def test_limits_of_a_joint_follow_the_joint_that_it_depends_on():
    angles = np.zeros(26)
    limit = MODEL.coupled_limits["LAnkleRoll"]
    roll = MODEL.joint_index["LAnkleRoll"]
    for pitch in limit.table[:, 0]:
        angles[MODEL.joint_index["LAnklePitch"]] = pitch
        lower, upper = BODY.limits(angles)
        least, most = limit.limits_at(pitch)
        joint = MODEL.joint("LAnkleRoll")
        assert lower[roll] == pytest.approx(max(least, joint.lower))
        assert upper[roll] == pytest.approx(min(most, joint.upper))
