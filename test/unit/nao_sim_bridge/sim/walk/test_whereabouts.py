"""Feet on the ground from a torso in the world and the angles of the legs."""

from __future__ import annotations

import math
import random

import pytest

from nao_sim_bridge.sim.frames import FEET, frame_of
from nao_sim_bridge.sim.kinematics import link_transforms, quaternion_matrix, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.readings import Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw
from nao_sim_bridge.sim.walk.body import WalkingBody
from nao_sim_bridge.sim.walk.footsteps import FootPose, middle
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.whereabouts import foot_on_ground, frame_from, robot_on_ground

MODEL = load_model()
BODY = WalkingBody(MODEL)


def some_torso(seed):
    r = random.Random(seed)
    turn = from_roll_pitch_yaw(r.uniform(-0.2, 0.2), r.uniform(-0.2, 0.2), r.uniform(-3.0, 3.0))
    return Pose((r.uniform(-1.0, 1.0), r.uniform(-1.0, 1.0), 0.3), turn)


def some_pose(seed):
    r = random.Random(seed)
    return FootPose(r.uniform(-2.0, 2.0), r.uniform(-2.0, 2.0), r.uniform(-3.0, 3.0))


@pytest.mark.parametrize("name", ["StandInit", "Crouch", "Sit"])
@pytest.mark.parametrize("seed", range(4))
def test_soles_are_where_the_kinematics_of_the_whole_robot_has_them(name, seed):
    angles, torso = posture(MODEL, name), some_torso(seed)
    links = link_transforms(MODEL, angles)
    world = transform(quaternion_matrix(torso.orientation), torso.position)
    for side, name in zip((LEFT, RIGHT), FEET):
        frame = frame_of(MODEL, name)
        sole = world @ links[frame.link] @ frame.offset
        expected = (sole[0, 3], sole[1, 3], math.atan2(sole[1, 0], sole[0, 0]))
        assert foot_on_ground(BODY, torso, angles, side) == pytest.approx(expected, abs=1e-6)


def test_the_robot_is_half_way_between_its_feet():
    angles, torso = posture(MODEL, "Stand"), some_torso(9)
    feet = [foot_on_ground(BODY, torso, angles, side) for side in (LEFT, RIGHT)]
    assert robot_on_ground(BODY, torso, angles) == pytest.approx(middle(*feet))


@pytest.mark.parametrize("seed", range(10))
def test_a_frame_has_things_where_they_were_seen(seed):
    there, here = some_pose(seed), some_pose(seed + 100)
    frame = frame_from(there, here)
    back = frame.moved(*here)
    assert back[:2] == pytest.approx(there[:2])
    assert math.cos(back.yaw - there.yaw) == pytest.approx(1.0)


@pytest.mark.parametrize("seed", range(10))
def test_a_frame_is_found_again_by_whatever_stands_in_it(seed):
    frame, here = some_pose(seed), some_pose(seed + 100)
    found = frame_from(frame.moved(*here), here)
    assert found[:2] == pytest.approx(frame[:2])
    assert math.cos(found.yaw - frame.yaw) == pytest.approx(1.0)
