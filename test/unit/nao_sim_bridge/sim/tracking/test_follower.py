"""Following places with head, body, arms and legs, under physics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import frame_of
from nao_sim_bridge.sim.kinematics import link_transforms, quaternion_matrix, transform
from nao_sim_bridge.sim.tracking.approach import Relative, goal_beside
from nao_sim_bridge.sim.tracking.follower import EFFECTORS, Follower, Mode
from nao_sim_bridge.sim.walk.footsteps import FootPose


class Eye:
    """A robot that stands, and how far its top camera looks beside a place."""

    def __init__(self, bench):
        self.bench = bench
        self.follower = Follower(bench.simulation)

    def off(self, place, name="CameraTop"):
        now, model = self.bench.now, self.bench.model
        torso = transform(quaternion_matrix(now.torso.orientation), now.torso.position)
        frame = frame_of(model, name)
        way = np.linalg.inv(torso @ link_transforms(model, now.positions)[frame.link] @ frame.offset)
        way = way @ np.array((*place, 1.0))
        return math.degrees(math.acos(way[0] / np.linalg.norm(way[:3])))


@pytest.fixture
def eye(bench):
    return Eye(bench())


def test_the_head_turns_to_a_place_and_follows_it(eye):
    for place in ((1.0, 0.5, 0.4), (1.0, -0.4, 0.6)):
        eye.follower.follow(place)
        eye.bench.run(1.0)
        assert eye.off(place) < 1.0
    eye.follower.stop()
    eye.bench.aim(HeadYaw=0.0, HeadPitch=0.0)
    eye.bench.run(0.8)
    assert abs(eye.bench.joint("HeadYaw")) < 0.02


def test_speed_and_acceleration_are_kept(eye):
    eye.follower.velocity, eye.follower.head.acceleration = 0.5, 1.0
    eye.follower.follow((0.0, 1.0, 0.5))
    dt = eye.bench.simulation.settings.tick_s
    yaws = [now.commands[0] for now in eye.bench.watch(1.0)]
    speeds = [(b - a) / dt for a, b in zip(yaws, yaws[1:])]
    assert max(speeds) == pytest.approx(0.5, abs=0.01)
    assert max((b - a) / dt for a, b in zip(speeds, speeds[1:])) < 1.1


def test_the_nearer_arm_points(eye):
    eye.follower.effector = EFFECTORS["Arms"]
    place = (1.0, 0.5, 0.4)
    right = eye.bench.joint("RShoulderPitch", of="commands")
    eye.follower.follow(place)
    eye.bench.run(2.0)
    assert eye.off(place, "LArm") < 6.0
    assert eye.bench.joint("RShoulderPitch", of="commands") == right


def test_the_whole_body_bends_for_what_is_too_low_for_the_head(eye):
    place = (0.5, 0.1, 0.05)
    eye.follower.follow(place)
    eye.bench.run(1.0)
    assert eye.off(place) > 10.0
    eye.follower.mode = Mode.WHOLE_BODY
    eye.follower.follow(place)
    eye.bench.run(3.0)
    assert eye.off(place) < 6.0
    assert eye.bench.robot.stability.on_feet
    eye.follower.stop()
    assert not eye.bench.robot.whole_body.enabled


def test_it_looks_around_for_what_is_lost_until_it_is_found(eye):
    eye.follower.search_share = 1.0
    eye.follower.search()
    yaws = [eye.bench.run(0.1) and eye.bench.joint("HeadYaw") for _ in range(28)]
    assert max(yaws) > 0.7
    assert min(yaws) < -0.2
    eye.follower.follow((1.0, 0.0, 0.5))
    eye.bench.run(1.0)
    assert eye.off((1.0, 0.0, 0.5)) < 1.0


def test_a_limp_head_stays_as_it_is(bench):
    eye = Eye(bench(stiffness=0.0))
    before = eye.bench.joint("HeadYaw", of="commands")
    eye.follower.follow((1.0, 1.0, 0.5))
    eye.bench.run(0.3)
    assert eye.bench.joint("HeadYaw", of="commands") == before


def test_the_place_beside_a_thing_is_on_the_robots_side_and_faces_it():
    goal = goal_beside(FootPose(0.0, 0.0, 1.0), (1.0, 1.0, 0.0), Relative(-0.5))
    assert goal.yaw == pytest.approx(math.pi / 4.0)
    assert math.hypot(1.0 - goal.x, 1.0 - goal.y) == pytest.approx(0.5)
    assert math.hypot(goal.x, goal.y) == pytest.approx(math.sqrt(2.0) - 0.5)
