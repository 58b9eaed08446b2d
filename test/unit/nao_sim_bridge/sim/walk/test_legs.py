"""Closed-form kinematics of the legs, against the kinematics of the whole robot."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from nao_sim_bridge.sim.kinematics import link_transforms, rpy_matrix
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT, SIDES, Legs, Sole, hip_rotation
from nao_sim_bridge.sim.walk.matrices import IDENTITY, about_z

MODEL = load_model()
LEGS = Legs(MODEL)
PARTS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
# Knees bent, so that there is one solution, rad.
RANGES = ((-0.3, 0.3), (-0.9, 0.3), (0.15, 1.5), (-0.9, 0.5), (-0.3, 0.3))


def some_angles(seed):
    """HipYawPitch and the other five angles of each leg, rad."""
    r = random.Random(seed)
    hip = r.uniform(-0.5, 0.3)
    legs = [tuple(r.uniform(*limits) for limits in RANGES) for _ in SIDES]
    return hip, dict(zip(SIDES, legs))


def poses(hip, legs):
    body = [0.0] * len(MODEL.joints)
    for side, angles in legs.items():
        for index, angle in zip(LEGS.indices[side], (hip, *angles)):
            body[index] = angle
    return link_transforms(MODEL, body)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("side", SIDES)
def test_where_a_leg_is_agrees_with_the_whole_robot(seed, side):
    hip, legs = some_angles(seed)
    links = poses(hip, legs)
    moment, ankle, foot = LEGS.state(side, hip, legs[side])
    pose = links[f"{SIDES[side]}AnkleRoll"]
    assert ankle == pytest.approx(pose[:3, 3], abs=1e-6)
    assert foot == pytest.approx(pose[:3, :3].ravel(), abs=1e-6)
    expected = sum(
        link.mass * (links[link.name] @ np.append(link.com, 1.0))[:3]
        for link in MODEL.links
        if link.name in [f"{SIDES[side]}{part}" for part in PARTS]
    )
    assert moment == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("side", SIDES)
def test_a_leg_finds_back_to_its_angles(seed, side):
    hip, legs = some_angles(seed)
    _, ankle, foot = LEGS.state(side, hip, legs[side])
    angles, off = LEGS.leg(side, hip, ankle, foot)
    assert angles == pytest.approx(legs[side], abs=1e-6)
    assert off == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("turn", [-0.3, 0.0, 0.3])
@pytest.mark.parametrize("step", [-0.05, 0.0, 0.06])
def test_both_soles_are_put_where_they_are_asked_for(turn, step):
    torso, lean = (0.01, 0.005, 0.3), tuple(rpy_matrix((0.02, 0.05, 0.03)).ravel())
    soles = {
        LEFT: Sole((step, 0.05, 0.0), about_z(turn)),
        RIGHT: Sole((-step, -0.05, 0.01), about_z(-turn)),
    }
    hip, left, right = LEGS.solve(torso, lean, soles[LEFT], soles[RIGHT], 0.0)
    matrix = np.array(lean).reshape(3, 3)
    turned_off = []
    for side, angles in ((LEFT, left), (RIGHT, right)):
        _, ankle, foot = LEGS.state(side, hip, angles)
        sole = matrix @ (np.array(ankle) - LEGS.sole_height * np.array(foot).reshape(3, 3)[:, 2]) + torso
        assert sole == pytest.approx(soles[side].position, abs=1e-4)
        off = np.array(soles[side].rotation).reshape(3, 3).T @ matrix @ np.array(foot).reshape(3, 3)
        assert off[2, 2] == pytest.approx(1.0, abs=1e-6), "the sole is not flat"
        turned_off.append(math.atan2(off[1, 0], off[0, 0]))
    # One motor for two hips: what it cannot do is shared out.
    assert turned_off[0] == pytest.approx(turned_off[1], abs=6e-3)
    assert abs(turned_off[0]) < 0.1


def test_a_sole_out_of_reach_stretches_the_leg():
    _, left, _ = LEGS.solve(
        (0.0, 0.0, 0.5), IDENTITY, Sole((0.0, 0.05, 0.0), IDENTITY), Sole((0.0, -0.05, 0.0), IDENTITY), 0.0
    )
    assert left[2] == pytest.approx(0.0, abs=0.1)


def test_the_hips_turn_as_mirror_images():
    mirror = np.diag([1.0, -1.0, 1.0])
    left, right = (np.array(hip_rotation(side, 0.4)).reshape(3, 3) for side in (LEFT, RIGHT))
    assert mirror @ left @ mirror == pytest.approx(right)
    assert left @ left.T == pytest.approx(np.eye(3))
