"""Odometry: where the robot believes that it is, against where it really is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import FEET, frame_of
from nao_sim_bridge.sim.kinematics import link_transforms, matrix_rpy, quaternion_matrix, rpy_matrix, transform
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.odometry import Odometry
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.readings import Contact

MODEL = load_model()
INIT = np.array(posture(MODEL, "StandInit"))
# The pitch of the torso, rad, when the feet are flat on the ground.
LEAN = 0.1
LEFT, RIGHT = 11, 22
UP = (0.0, 0.0, 1.0)


def load(left, right):
    feet = ((LEFT, left), (RIGHT, right))
    return [Contact(link, (0.0, 0.0, 0.0), UP, force) for link, force in feet if force]


def matrix(pose):
    return transform(quaternion_matrix(pose.orientation), pose.position)


def feet(torso, angles):
    """(4, 4) poses of the soles for a torso in world."""
    links = link_transforms(MODEL, angles)
    frames = [frame_of(MODEL, name) for name in FEET]
    return [torso @ links[frame.link] @ frame.offset for frame in frames]


def turned(angles, **joints):
    changed = angles.copy()
    for name, angle in joints.items():
        changed[MODEL.joint_index[name]] += angle
    return changed


@pytest.fixture
def odometry():
    return Odometry(MODEL, (LEFT, RIGHT), INIT, (0.0, LEAN, 1.0))


def test_the_world_begins_between_the_feet(odometry):
    left, right = feet(matrix(odometry.torso), INIT)
    assert (left[:3, 3] + right[:3, 3]) / 2 == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    assert left[:3, 0] + right[:3, 0] == pytest.approx([2.0, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("side, loads", [(0, (40.0, 5.0)), (1, (5.0, 40.0))])
def test_the_foot_that_carries_stays_where_it_is(odometry, side, loads):
    odometry.update(INIT, (0.0, LEAN, 1.0), load(*loads))
    before = feet(matrix(odometry.torso), INIT)[side]
    leaning = turned(INIT, LAnklePitch=-0.1, RAnklePitch=-0.1)
    after = feet(matrix(odometry.update(leaning, (0.0, LEAN + 0.1, 1.0), load(*loads))), leaning)[side]
    assert after == pytest.approx(before, abs=1e-6)


def test_steps_add_up(odometry):
    """A robot that shuffles: each leg in turn swings the body ahead."""
    reach = turned(INIT, LHipPitch=-0.1, LAnklePitch=0.1)
    back = turned(INIT, RHipPitch=-0.1, RAnklePitch=0.1)
    leaning = transform(rpy_matrix((0.0, LEAN, 0.0)), (0.0, 0.0, 0.0))
    length = feet(leaning, reach)[0][0, 3] - feet(leaning, INIT)[0][0, 3]
    assert length > 0.01
    odometry.update(INIT, (0.0, LEAN, 1.0), load(0.0, 40.0))
    begin = odometry.torso.position
    for _ in range(3):
        odometry.update(reach, (0.0, LEAN, 1.0), load(0.0, 40.0))  # the left foot is ahead, in the air
        odometry.update(reach, (0.0, LEAN, 1.0), load(40.0, 0.0))
        odometry.update(INIT, (0.0, LEAN, 1.0), load(40.0, 0.0))  # the body follows
        odometry.update(back, (0.0, LEAN, 1.0), load(40.0, 0.0))
        odometry.update(back, (0.0, LEAN, 1.0), load(0.0, 40.0))
        odometry.update(INIT, (0.0, LEAN, 1.0), load(0.0, 40.0))
    assert odometry.torso.position[0] - begin[0] == pytest.approx(6 * length, abs=1e-3)
    assert odometry.torso.position[1] == pytest.approx(begin[1], abs=2e-3)


def test_headings_come_from_the_inertial_unit(odometry):
    odometry.update(INIT, (0.0, LEAN, 1.5), load(20.0, 20.0))
    assert matrix_rpy(quaternion_matrix(odometry.torso.orientation))[2] == pytest.approx(0.5)


def test_a_robot_in_the_air_stays_where_it_was(odometry):
    before = odometry.torso.position
    odometry.update(turned(INIT, LKneePitch=0.5, RKneePitch=0.5), (0.3, 0.2, 1.0), [])
    assert odometry.torso.position == pytest.approx(before)


def test_it_knows_where_a_standing_robot_is_while_it_moves(bench):
    one = bench("StandInit")
    offset = None
    for pitch, roll in ((0.1, 0.0), (-0.1, 0.05), (0.0, -0.05)):
        one.aim(
            speed=0.5, LHipPitch=-0.45 + pitch, RHipPitch=-0.45 + pitch, LHipRoll=roll, RHipRoll=roll,
            LAnkleRoll=-roll, RAnkleRoll=-roll,
        )  # fmt: skip
        now = one.run(1.0)
        truth, reckoned = (transform(quaternion_matrix(p.orientation), p.position) for p in (now.torso, now.odometry))
        # The start in world: it must come out the same all the time.
        start = truth @ np.linalg.inv(reckoned)
        offset = start if offset is None else offset
        assert start == pytest.approx(offset, abs=2e-3)
    assert math.hypot(offset[2, 3], *offset[2, :2]) < 0.005
    assert rpy_matrix((0.0, 0.0, matrix_rpy(offset[:3, :3])[2])) == pytest.approx(offset[:3, :3], abs=5e-3)
