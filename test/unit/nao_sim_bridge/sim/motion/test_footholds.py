"""Feet under whole body control: which one stands, what the other keeps, and what they carry."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import FEET, frame_of
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.body_kinematics import body_kinematics
from nao_sim_bridge.sim.motion.footholds import Footholds, FootState
from nao_sim_bridge.sim.motion.grounded_pose import GroundedPose
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
BODY = body_kinematics(MODEL)
LEFT, RIGHT = (frame_of(MODEL, foot) for foot in FEET)


def standing(name="StandInit", **joints):
    """Feet put down in a posture with some joints (rad) elsewhere."""
    angles = np.array(posture(MODEL, name))
    for joint, angle in joints.items():
        angles[MODEL.joint_index[joint]] += angle
    feet = Footholds(BODY)
    feet.put_down(BODY.at(angles))
    return feet, GroundedPose(BODY.at(angles), feet.footing)


def test_the_left_foot_stands_and_the_right_one_is_kept():
    feet, _ = standing()
    assert feet.footing.foot.link == LEFT.link
    assert [goal.mask for goal in feet.kept] == [63]
    assert feet.kept[0].pose[:3, 3] == pytest.approx([0.0, -0.1, 0.0], abs=1e-3)


@pytest.mark.parametrize("name, joints", [("Crouch", {}), ("StandInit", {"RAnklePitch": 0.03})])
def test_soles_that_a_posture_tilts_a_little_become_flat(name, joints):
    feet, now = standing(name, **joints)
    assert abs(now.pose(RIGHT)[2, 2]) < 1.0 - 1e-6
    assert feet.kept[0].pose[:3, 2] == pytest.approx([0.0, 0.0, 1.0])


def test_a_foot_in_the_air_stays_there():
    feet, now = standing(RHipPitch=-0.4, RKneePitch=0.8, RAnklePitch=-0.4)
    assert feet.kept[0].pose == pytest.approx(now.pose(RIGHT), abs=1e-6)
    assert feet.on_ground(now, FEET) == ["LLeg"]


def test_a_free_foot_keeps_nothing_and_carries_nothing():
    feet, now = standing()
    feet.set_state("LLeg", FootState.FREE, now)
    assert feet.footing.foot.link == RIGHT.link
    assert feet.kept == []
    assert feet.on_ground(now, FEET) == list(FEET)
    assert feet.carrying(now, FEET) == ["RLeg"]
    feet.set_state("RLeg", FootState.FREE, now)
    assert feet.footing is None


def test_a_foot_in_its_plane_keeps_height_roll_and_pitch():
    feet, now = standing()
    feet.set_state("LLeg", FootState.PLANE, now)
    assert feet.footing.foot.link == RIGHT.link
    assert [(goal.frame.link, goal.mask) for goal in feet.kept] == [(LEFT.link, 4 | 8 | 16)]


def test_the_region_of_two_feet_is_wider_than_that_of_one():
    feet, now = standing()
    both, one = feet.region(now, FEET), feet.region(now, ["LLeg"])
    between = (now.pose(LEFT)[:2, 3] + now.pose(RIGHT)[:2, 3]) / 2.0
    assert both.excess(between).max() < 0.0 < one.excess(between).max()
    assert one.center[1] == pytest.approx(0.0, abs=0.01)
