"""Inverse kinematics against forward kinematics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import frame_of
from nao_sim_bridge.sim.kinematics import axis_matrix, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion import inverse_kinematics
from nao_sim_bridge.sim.motion.body_kinematics import body_kinematics
from nao_sim_bridge.sim.motion.inverse_kinematics import Goal, rotation_vector, solve
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
BODY = body_kinematics(MODEL)
STAND = np.array(posture(MODEL, "Stand"))
ARM = frame_of(MODEL, "LArm")


def chain(name):
    return [MODEL.joint_index[j] for j in MODEL.chains[name] if not MODEL.joint(j).is_hand]


def shaken(indices, size, generator):
    """`STAND` with some joints moved, within the limits."""
    angles = STAND.copy()
    angles[indices] += generator.uniform(-size, size, len(indices))
    angles[BODY.right_hip] = angles[BODY.left_hip]
    return np.clip(angles, *BODY.limits(angles))


@pytest.mark.parametrize("angle", [0.0, 1e-8, 0.5, 3.0, math.pi])
def test_a_rotation_vector_is_axis_times_angle(angle):
    axis = np.array([0.6, 0.0, 0.8])
    assert rotation_vector(axis_matrix(axis, angle)) == pytest.approx(axis * angle, abs=1e-7)


@pytest.mark.parametrize("names, mask", [(["LArm"], 7), (["LArm", "RArm"], 63), (["LLeg", "RLeg"], 63)])
def test_reachable_poses_are_reached_within_the_limits(names, mask):
    generator = np.random.default_rng(1)
    indices = [i for name in names for i in chain(name)]
    frames = [frame_of(MODEL, name) for name in names]
    for _ in range(10):
        wanted = BODY.at(shaken(indices, 0.25, generator))
        found = solve(BODY, indices, [Goal(frame, wanted.pose(frame), mask) for frame in frames], STAND)
        lower, upper = BODY.limits(found)
        assert np.all(found[indices] >= lower[indices] - 1e-9) and np.all(found[indices] <= upper[indices] + 1e-9)
        assert found[BODY.right_hip] == found[BODY.left_hip]
        for frame in frames:
            assert BODY.at(found).pose(frame)[:3, 3] == pytest.approx(wanted.pose(frame)[:3, 3], abs=1e-3)


def test_joints_that_are_not_named_stay():
    target = transform(np.eye(3), (0.1, 0.15, 0.05))
    found = solve(BODY, chain("LArm"), [Goal(ARM, target, 7)], STAND)
    others = [i for i in range(26) if i not in chain("LArm")]
    assert found[others] == pytest.approx(STAND[others])


@pytest.fixture
def iterations(monkeypatch):
    """Counts the iterations of the solver."""
    counted = []
    original = inverse_kinematics.ranked_step
    monkeypatch.setattr(inverse_kinematics, "ranked_step", lambda *a: counted.append(1) or original(*a))
    return counted


@pytest.mark.parametrize("mask", [7, 63])
def test_a_target_out_of_reach_stretches_the_arm_towards_it_and_the_search_ends_soon(mask, iterations):
    target = transform(np.eye(3), (1.0, 0.1, 0.1))
    found = BODY.at(solve(BODY, chain("LArm"), [Goal(ARM, target, mask)], STAND)).pose(ARM)
    shoulder = MODEL.joint("LShoulderPitch").origin
    toward = (target[:3, 3] - shoulder) / np.linalg.norm(target[:3, 3] - shoulder)
    reach = found[:3, 3] - shoulder
    assert np.linalg.norm(reach) > 0.2
    assert reach @ toward / np.linalg.norm(reach) > 0.99
    assert len(iterations) <= 25


def test_legs_with_knees_bent_backwards_lower_the_torso_all_the_same():
    legs = chain("LLeg") + chain("RLeg")
    now = BODY.at(STAND)
    assert STAND[MODEL.joint_index["LKneePitch"]] < 0.0
    feet = [frame_of(MODEL, name) for name in ("LLeg", "RLeg")]
    raised = [now.pose(foot) @ transform(np.eye(3), (0.0, 0.0, 0.03)) for foot in feet]
    found = BODY.at(solve(BODY, legs, [Goal(foot, pose, 7) for foot, pose in zip(feet, raised)], STAND))
    for foot, pose in zip(feet, raised):
        assert found.pose(foot)[:3, 3] == pytest.approx(pose[:3, 3], abs=1e-4)


def test_axes_outside_the_mask_do_not_matter():
    target = BODY.at(STAND).pose(ARM)
    target[:3, 3] += (9.0, 9.0, 0.03)
    found = solve(BODY, chain("LArm"), [Goal(ARM, target, 4)], STAND)
    assert BODY.at(found).pose(ARM)[2, 3] == pytest.approx(target[2, 3], abs=1e-4)


def test_what_must_hold_holds_when_another_goal_is_against_it():
    legs = chain("LLeg") + chain("RLeg")
    left, right = (frame_of(MODEL, name) for name in ("LLeg", "RLeg"))
    now = BODY.at(STAND)
    turned = now.pose(left) @ transform(axis_matrix((0.0, 0.0, 1.0), 0.5), (0.0, 0.0, 0.02))
    found = BODY.at(solve(BODY, legs, [Goal(right, now.pose(right), rank=0), Goal(left, turned)], STAND))
    assert found.pose(right) == pytest.approx(now.pose(right), abs=1e-4)
    assert found.pose(left)[2, 3] > now.pose(left)[2, 3] + 0.005
