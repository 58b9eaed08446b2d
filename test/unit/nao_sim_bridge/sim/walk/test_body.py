"""The walking body: its centre of mass and feet against the robot's other kinematics."""

from __future__ import annotations

import random

import pytest

from nao_sim_bridge.sim.kinematics import link_transforms
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.stance import StanceReader
from nao_sim_bridge.sim.walk.body import WalkingBody

MODEL = load_model()
BODY = WalkingBody(MODEL)


def some_angles(seed):
    """Anything within the limits, with both hip yaws alike as their one motor has them, rad."""
    r = random.Random(seed)
    angles = [r.uniform(joint.lower, joint.upper) for joint in MODEL.joints]
    angles[MODEL.joint_index["RHipYawPitch"]] = angles[MODEL.joint_index["LHipYawPitch"]]
    return angles


@pytest.mark.parametrize("seed", range(10))
def test_its_centre_of_mass_is_that_of_the_stance(seed):
    angles = some_angles(seed)
    com, _ = BODY.center_of_mass(BODY.upper_moment(angles), BODY.leg_pose(angles))
    assert com == pytest.approx(StanceReader(MODEL).read(angles, 0.0, 0.0).com, abs=1e-6)


@pytest.mark.parametrize("seed", range(10))
def test_its_feet_are_those_of_the_whole_robot(seed):
    angles = some_angles(seed)
    links = link_transforms(MODEL, angles)
    _, legs = BODY.center_of_mass(BODY.upper_moment(angles), BODY.leg_pose(angles))
    for side, (ankle, foot) in zip("LR", legs):
        pose = links[f"{side}AnkleRoll"]
        assert ankle == pytest.approx(pose[:3, 3], abs=1e-6)
        assert foot == pytest.approx(pose[:3, :3].ravel(), abs=1e-6)


def test_it_weighs_what_the_robot_weighs():
    assert BODY.mass == pytest.approx(MODEL.total_mass)


def test_legs_are_no_part_of_what_is_above_them():
    angles, other = some_angles(1), some_angles(2)
    for leg in ("LLeg", "RLeg"):
        for name in MODEL.chains[leg]:
            other[MODEL.joint_index[name]] = angles[MODEL.joint_index[name]]
    lifted = list(angles)
    for name in MODEL.chains["LLeg"]:
        lifted[MODEL.joint_index[name]] = 0.0
    assert BODY.upper_moment(lifted) == BODY.upper_moment(angles)
    assert BODY.upper_moment(other) != BODY.upper_moment(angles)
    assert BODY.leg_pose(other) == BODY.leg_pose(angles)
