"""Inverse kinematics against forward kinematics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import frame_of
from nao_sim_bridge.sim.kinematics import axis_matrix, link_transforms, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.cartesian_path import PosePath, joint_curves, sample_times
from nao_sim_bridge.sim.motion.inverse_kinematics import rotation_vector, solve
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
STAND = posture(MODEL, "Stand")
AXES = np.eye(3)


def chain(name):
    return [MODEL.joint_index[j] for j in MODEL.chains[name] if not MODEL.joint(j).is_hand]


def pose_at(name, indices, angles):
    whole = list(STAND)
    for index, angle in zip(indices, angles):
        whole[index] = angle
    frame = frame_of(MODEL, name)
    return link_transforms(MODEL, whole)[frame.link] @ frame.offset


@pytest.mark.parametrize("angle", [0.0, 1e-8, 0.5, 3.0, math.pi])
def test_a_rotation_vector_is_axis_times_angle(angle):
    axis = np.array([0.6, 0.0, 0.8])
    assert rotation_vector(axis_matrix(axis, angle)) == pytest.approx(axis * angle, abs=1e-7)


@pytest.mark.parametrize("name, mask", [("LArm", 7), ("RArm", 7), ("LLeg", 63), ("RLeg", 63)])
def test_reachable_poses_are_reached_within_the_limits(name, mask):
    generator, indices = np.random.default_rng(1), chain(name)
    limits = MODEL.limits_array()[indices]
    for _ in range(20):
        start = np.array([STAND[i] for i in indices])
        wanted = np.clip(start + generator.uniform(-0.25, 0.25, len(indices)), limits[:, 0], limits[:, 1])
        target = pose_at(name, indices, wanted)
        found = solve(MODEL, indices, frame_of(MODEL, name), target, mask, AXES, STAND)
        assert np.all(found >= limits[:, 0] - 1e-12) and np.all(found <= limits[:, 1] + 1e-12)
        assert pose_at(name, indices, found)[:3, 3] == pytest.approx(target[:3, 3], abs=1e-3)


def test_a_target_out_of_reach_stretches_the_arm_towards_it():
    indices = chain("LArm")
    target = transform(np.eye(3), (1.0, 0.1, 0.1))
    found = pose_at("LArm", indices, solve(MODEL, indices, frame_of(MODEL, "LArm"), target, 7, AXES, STAND))
    shoulder = MODEL.joint("LShoulderPitch").origin
    toward = (target[:3, 3] - shoulder) / np.linalg.norm(target[:3, 3] - shoulder)
    reach = found[:3, 3] - shoulder
    assert np.linalg.norm(reach) > 0.2
    assert reach @ toward / np.linalg.norm(reach) > 0.99


def test_axes_outside_the_mask_do_not_matter():
    indices = chain("LArm")
    now = pose_at("LArm", indices, [STAND[i] for i in indices])
    target = now.copy()
    target[:3, 3] += (9.0, 9.0, 0.03)
    found = solve(MODEL, indices, frame_of(MODEL, "LArm"), target, 4, AXES, STAND)
    assert pose_at("LArm", indices, found)[2, 3] == pytest.approx(target[2, 3], abs=1e-4)


def test_a_path_is_straight_between_its_poses():
    indices = chain("LArm")
    now = pose_at("LArm", indices, [STAND[i] for i in indices])
    end = now.copy()
    end[:3, 3] += (0.04, 0.0, 0.04)
    times = (0.0, 1.0)
    path = PosePath(times, [now, end])
    curves = joint_curves(MODEL, indices, frame_of(MODEL, "LArm"), path, times, 7, np.eye(4), STAND)
    for moment in np.linspace(0.0, 1.0, 21):
        found = pose_at("LArm", indices, [curves[i].value(moment) for i in indices])
        assert found[:3, 3] == pytest.approx(path.pose(moment)[:3, 3], abs=2e-3)


def test_samples_hold_every_key_time_and_few_between():
    at = sample_times((0.0, 0.25, 100.0))
    assert at[0] == 0.0 and at[-1] == 100.0 and 0.25 in at
    assert len(at) < 30
