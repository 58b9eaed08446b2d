"""Kinematics of legs and walking body, against those of the whole robot."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim_bridge.model.kinematics import link_transforms
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.walk.body import WalkingBody
from nao_sim_bridge.walk.legs import LEFT, RIGHT, SIDES

MODEL = load_model()
BODY = WalkingBody(MODEL)
LEGS = BODY.legs
PARTS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
# Knees bent, so that there is one solution, rad.
RANGES = ((-0.3, 0.3), (-0.9, 0.3), (0.15, 1.5), (-0.9, 0.5), (-0.3, 0.3))


@st.composite
def bodies(draw):
    """(26,) angles: bent legs, both hip yaws alike as their one motor has them, the rest within limits, rad."""
    angles = [draw(st.floats(joint.lower, joint.upper)) for joint in MODEL.joints]
    hip = draw(st.floats(-0.5, 0.3))
    for side in SIDES:
        values = (hip, *(draw(st.floats(*limits)) for limits in RANGES))
        for index, angle in zip(LEGS.indices[side], values):
            angles[index] = angle
    return angles


@given(bodies(), st.sampled_from((LEFT, RIGHT)))
def test_a_leg_is_where_the_whole_robot_has_it_and_finds_back_to_its_angles(angles, side):
    links = link_transforms(MODEL, angles)
    hip, *legs = BODY.leg_pose(angles)
    leg = legs[0 if side == LEFT else 1]
    moment, ankle, foot = LEGS.state(side, hip, leg)
    pose = links[f"{SIDES[side]}AnkleRoll"]
    assert ankle == pytest.approx(pose[:3, 3], abs=1e-6)
    assert foot == pytest.approx(pose[:3, :3].ravel(), abs=1e-6)
    parts = [link for link in MODEL.links if link.name in [f"{SIDES[side]}{part}" for part in PARTS]]
    expected = sum(link.mass * (links[link.name] @ np.append(link.com, 1.0))[:3] for link in parts)
    assert moment == pytest.approx(expected, abs=1e-6)
    found, off = LEGS.leg(side, hip, ankle, foot)
    assert found == pytest.approx(leg, abs=1e-6) and off == pytest.approx(0.0, abs=1e-6)
