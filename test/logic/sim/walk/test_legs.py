"""Kinematics of legs and walking body, against those of the whole robot."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim_bridge.sim.frames import FEET, frame_of
from nao_sim_bridge.sim.kinematics import link_transforms, quaternion_matrix, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw
from nao_sim_bridge.sim.walk.body import WalkingBody
from nao_sim_bridge.sim.walk.footsteps import middle
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT, SIDES
from nao_sim_bridge.sim.walk.whereabouts import foot_on_ground, robot_on_ground

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


@given(bodies(), st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(-3.0, 3.0))
@settings(max_examples=20)
def test_soles_on_the_ground_are_where_the_whole_robot_has_them(angles, roll, pitch, yaw):
    torso = Pose((0.4, -0.7, 0.3), from_roll_pitch_yaw(roll, pitch, yaw))
    links = link_transforms(MODEL, angles)
    world = transform(quaternion_matrix(torso.orientation), torso.position)
    feet = [foot_on_ground(BODY, torso, angles, side) for side in (LEFT, RIGHT)]
    for foot, name in zip(feet, FEET):
        frame = frame_of(MODEL, name)
        sole = world @ links[frame.link] @ frame.offset
        assert foot == pytest.approx((sole[0, 3], sole[1, 3], math.atan2(sole[1, 0], sole[0, 0])), abs=1e-6)
    assert robot_on_ground(BODY, torso, angles) == pytest.approx(middle(*feet))
