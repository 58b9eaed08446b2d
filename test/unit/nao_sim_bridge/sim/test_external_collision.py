"""Obstacles that the sonars see, and arms that slow down before them."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.external_collision import SLOWEST, ExternalCollision
from nao_sim_bridge.sim.kinematics import link_transforms
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()
SHOULDER = MODEL.joint_index["LShoulderPitch"]
FAR = 5.0
STAND = posture(MODEL, "Stand")
# Both arms straight ahead.
AHEAD = posture(MODEL, "StandZero")


@pytest.fixture
def external():
    return ExternalCollision(MODEL)


def hand(arm):
    links, place = link_transforms(MODEL, AHEAD), MODEL.effectors[arm]
    link = links[place.parent_link]
    return link[:3, :3] @ place.position + link[:3, 3]


def sonar(index):
    return np.asarray(MODEL.sonars[index].position)


def test_nothing_in_sight_is_no_obstacle(external):
    assert external.closest_obstacle("LArm", STAND, (FAR, FAR)) is None
    assert external.speed_shares(AHEAD, (FAR, FAR)) == {}


def test_an_obstacle_is_on_the_axis_of_its_sonar_and_the_nearer_one_counts(external):
    left = external.closest_obstacle("LArm", AHEAD, (0.5, FAR))
    assert np.linalg.norm(left - sonar(0)) == pytest.approx(0.5)
    assert left[0] > 0.4 and left[1] > 0.0
    both = external.closest_obstacle("LArm", AHEAD, (0.9, 0.3))
    assert np.linalg.norm(both - sonar(1)) == pytest.approx(0.3)


def test_an_arm_slows_down_as_it_comes_near(external):
    far = float(np.linalg.norm(hand("LArm") - sonar(0)))
    shares = [
        external.speed_shares(AHEAD, (far + gap, FAR)).get(MODEL.joint_index["LShoulderPitch"], 1.0)
        for gap in (0.5, 0.11, 0.09, 0.06, 0.021, 0.0)
    ]
    assert shares[:2] == [1.0, 1.0]
    assert shares[2] > shares[3] > shares[4]
    assert shares[-1] == SLOWEST


def test_an_arm_that_hangs_down_is_not_in_the_way(external):
    assert external.speed_shares(STAND, (0.15, 0.15)) == {}


def test_only_protected_arms_slow_down(external):
    echoes = (float(np.linalg.norm(hand("LArm") - sonar(0))),) * 2
    external.enabled.discard("LArm")
    slowed = {MODEL.joints[i].name for i in external.speed_shares(AHEAD, echoes)}
    assert slowed == set(MODEL.chains["RArm"])
    external.enabled.clear()
    assert external.speed_shares(AHEAD, echoes) == {}


def test_a_robot_before_a_wall_stretches_its_arm_slowly(bench, world_file):
    """The wall is further away than the hand gets, and closer than the security distance."""
    wall = "{name: wall, box: [0.1, 2.0, 1.5], position: [0.36, 0.0, 0.75]}"
    peaks = []
    for world in ("empty", world_file(wall)):
        one = bench(world=world)
        one.run(0.3)
        one.aim(2.0, LShoulderPitch=0.6, LElbowRoll=-0.1, LShoulderRoll=0.0)
        one.robot.reflexes.external_collision.tangential = 0.2
        one.run(1.5)
        one.aim(8.0, LShoulderPitch=0.1)
        told = [snapshot.commands[SHOULDER] for snapshot in one.watch(1.0)]
        assert told[-1] == pytest.approx(0.1)
        peaks.append(max(abs(b - a) for a, b in zip(told, told[1:])))
    assert peaks[1] < 0.6 * peaks[0]
