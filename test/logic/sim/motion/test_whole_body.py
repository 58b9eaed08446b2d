"""The region of balance, and feet that stand, slide or are free."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.control.whole_body.footholds import (
    CORE,
    FRONT,
    MARGIN,
    Footholds,
    FootState,
    balance_region,
    sole_corners,
)
from nao_sim_bridge.control.whole_body.grounded_pose import GroundedPose
from nao_sim_bridge.model.frames import FEET, frame_of
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture

MODEL = load_model()
BODY = body_kinematics(MODEL)
LEFT, RIGHT = (frame_of(MODEL, name) for name in FEET)


def test_the_region_of_balance_is_the_support_without_its_rim():
    square = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.0, 0.2)]
    region = balance_region([*square, (0.1, 0.1), (0.2, 0.05)])
    assert region.center == pytest.approx([0.2, 0.1]) and len(region.limits) == 4
    assert region.excess(region.center).max() == pytest.approx(MARGIN - 0.1)
    assert [region.excess(np.array(corner)).max() for corner in square] == pytest.approx([MARGIN] * 4)
    narrow = balance_region([(0.0, 0.0), (0.4, 0.0), (0.4, 0.04), (0.0, 0.04)])
    assert -narrow.excess(narrow.center).max() == pytest.approx(CORE * 0.02), "of a narrow support a core is left"
    pose = np.eye(4)
    pose[:2, 3] = (1.0, 2.0)
    for foot, side in zip(FEET, (1.0, -1.0)):
        expected = np.minimum(MODEL.sole_contour, (FRONT, 1.0)) * (1.0, side) + (1.0, 2.0)
        found = sole_corners(MODEL, foot, pose)
        assert sorted(map(tuple, found.round(6))) == sorted(map(tuple, expected.round(6)))


def standing(name="StandInit", **joints):
    """Feet put down in a posture with some joints (rad) elsewhere."""
    angles = np.array(posture(MODEL, name))
    for joint, angle in joints.items():
        angles[MODEL.joint_index[joint]] += angle
    feet = Footholds(BODY)
    feet.put_down(BODY.at(angles))
    return feet, GroundedPose(BODY.at(angles), feet.footing)


def test_the_left_foot_stands_and_the_right_one_is_kept_flat_or_in_the_air():
    feet, now = standing()
    assert feet.footing.foot.link == LEFT.link and [goal.mask for goal in feet.kept] == [63]
    assert feet.kept[0].pose[:3, 3] == pytest.approx([0.0, -0.1, 0.0], abs=1e-3)
    both, one = feet.region(now, FEET), feet.region(now, ["LLeg"])
    between = (now.pose(LEFT)[:2, 3] + now.pose(RIGHT)[:2, 3]) / 2.0
    assert both.excess(between).max() < 0.0 < one.excess(between).max()
    assert one.center[1] == pytest.approx(0.0, abs=0.01)
    for tilted, now in (standing("Crouch"), standing(RAnklePitch=0.03)):
        assert abs(now.pose(RIGHT)[2, 2]) < 1.0 - 1e-6
        assert tilted.kept[0].pose[:3, 2] == pytest.approx([0.0, 0.0, 1.0])
    feet, now = standing(RHipPitch=-0.4, RKneePitch=0.8, RAnklePitch=-0.4)
    assert feet.kept[0].pose == pytest.approx(now.pose(RIGHT), abs=1e-6) and feet.on_ground(now, FEET) == ["LLeg"]


def test_a_foot_in_its_plane_keeps_height_roll_and_pitch_and_a_free_one_nothing():
    feet, now = standing()
    feet.set_state("LLeg", FootState.PLANE, now)
    assert feet.footing.foot.link == RIGHT.link
    assert [(goal.frame.link, goal.mask) for goal in feet.kept] == [(LEFT.link, 4 | 8 | 16)]
    feet.set_state("LLeg", FootState.FREE, now)
    assert feet.footing.foot.link == RIGHT.link and feet.kept == []
    assert (feet.on_ground(now, FEET), feet.carrying(now, FEET)) == (list(FEET), ["RLeg"])
    feet.set_state("RLeg", FootState.FREE, now)
    assert feet.footing is None
