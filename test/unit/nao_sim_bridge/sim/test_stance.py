"""Stances agree with the matrices of the kinematics, for any angles."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.kinematics import center_of_mass, link_transforms, rpy_matrix
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.stance import StanceReader

MODEL = load_model()
READER = StanceReader(MODEL)


@pytest.fixture(params=range(5))
def case(request):
    """Angles within the limits, and a lean of the torso."""
    chance = np.random.default_rng(request.param)
    lower, upper = MODEL.limits_array().T
    return chance.uniform(lower, upper).tolist(), *chance.uniform(-1.0, 1.0, 2).tolist()


def test_centre_of_mass_and_ankles_are_those_of_the_kinematics(case):
    angles, roll, pitch = case
    level, links = rpy_matrix((roll, pitch, 0.0)), link_transforms(MODEL, angles)
    stance = READER.read(angles, roll, pitch)
    assert stance.com == pytest.approx(level @ center_of_mass(MODEL, angles))
    left, right = (level @ links[f"{side}AnkleRoll"][:3, 3] for side in "LR")
    assert stance.left_ankle == pytest.approx(left)
    assert stance.right_ankle == pytest.approx(right)
    assert stance.com_from_feet == pytest.approx(stance.com - (left + right) / 2)


@pytest.mark.parametrize("side, letter", enumerate("LR"))
def test_soles_are_where_the_kinematics_has_them(case, side, letter):
    angles, roll, pitch = case
    foot = link_transforms(MODEL, angles)[f"{letter}AnkleRoll"]
    outline = MODEL.sole_polygon(letter)
    corners = np.c_[outline, np.full(len(outline), -MODEL.sole_height), np.ones(len(outline))]
    expected = (rpy_matrix((roll, pitch, 0.0)) @ (corners @ foot.T)[:, :3].T).T
    assert np.array(READER.sole(side, angles, roll, pitch)) == pytest.approx(expected)


@pytest.mark.parametrize("name, pitch", [("Stand", -0.002), ("StandZero", 0.0), ("StandInit", 0.1), ("Crouch", -0.05)])
def test_the_lean_of_a_posture_follows_from_flat_soles(name, pitch):
    angles = posture(MODEL, name)
    assert READER.lean(angles) == pytest.approx((0.0, pitch), abs=1e-3)
    heights = [corner[2] for side in (0, 1) for corner in READER.sole(side, angles, *READER.lean(angles))]
    assert max(heights) - min(heights) < 0.005


def test_leaning_forward_moves_the_centre_of_mass_ahead_of_the_feet():
    angles = posture(MODEL, "Stand")
    upright, leaning = READER.read(angles, 0.0, 0.0), READER.read(angles, 0.0, 0.1)
    ahead = leaning.com_from_feet[0] - upright.com_from_feet[0]
    assert ahead == pytest.approx(0.1 * upright.com_from_feet[2], rel=0.05)
