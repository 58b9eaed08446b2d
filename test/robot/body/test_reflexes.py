"""What keeps a body in physics from harm, alive and still: whole body control, arms, breath, stiffness, tracking."""

import math

import numpy as np
import pytest

from nao_sim_bridge.base.rotations import roll_pitch_yaw
from nao_sim_bridge.control.whole_body.aims import TargetAim
from nao_sim_bridge.control.whole_body.footholds import FootState
from nao_sim_bridge.control.whole_body.tasks import go_to_balance
from nao_sim_bridge.model.frames import FEET, frame_of
from nao_sim_bridge.model.kinematics import link_transforms, quaternion_matrix, transform
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.tracking.follower import Follower
from nao_sim_bridge.tracking.follower import Mode as Tracking

INDEX = load_model().joint_index
OTHER = dict(zip(FEET, reversed(FEET)))


def upright(snapshot):
    return max(abs(angle) for angle in roll_pitch_yaw(snapshot.torso.orientation)[:2]) < 0.2


def load(snapshot, foot):
    return (snapshot.left_foot if foot == "LLeg" else snapshot.right_foot).total


@pytest.fixture
def over(bench):
    """Makes standing robots whose centre of mass is over one foot, the other one free."""

    def make(foot):
        one = bench("StandInit")
        one.run(0.2)
        robot = one.robot
        robot.whole_body.enable(True)
        task = go_to_balance(robot.whole_body, robot.motion, robot.joints, "go", [foot], 1.5)
        one.run(2.0)
        assert task.value is True and load(one.now, foot) > 35.0
        robot.whole_body.set_foot_states([OTHER[foot]], FootState.FREE)
        return one

    return make


@pytest.mark.parametrize("foot", FEET)
def test_it_stands_on_one_foot(over, foot):
    one = over(foot)
    control = one.robot.whole_body
    goal = control.goal_here(OTHER[foot])
    raised = goal.pose.copy()
    raised[2, 3] += 0.05
    control.lead(OTHER[foot], TargetAim(goal, raised, (0.1, 1.0)))
    one.run(2.0)
    held = one.watch(2.5)
    assert all(load(snapshot, OTHER[foot]) == 0.0 for snapshot in held) and upright(held[-1])
    assert np.abs(np.subtract(held[-1].torso.position, held[0].torso.position)).max() < 2e-3


def test_a_robot_before_a_wall_stretches_its_arm_slowly(bench, world_file):
    """The wall is further away than the hand gets, and closer than the security distance."""
    wall, peaks = "{name: wall, box: [0.1, 2.0, 1.5], position: [0.36, 0.0, 0.75]}", []
    for world in ("empty", world_file(wall)):
        one = bench(world=world)
        one.run(0.3)
        one.aim(2.0, LShoulderPitch=0.6, LElbowRoll=-0.1, LShoulderRoll=0.0)
        one.robot.reflexes.external_collision.tangential = 0.2
        one.run(1.5)
        one.aim(8.0, LShoulderPitch=0.1)
        told = [snapshot.commands[INDEX["LShoulderPitch"]] for snapshot in one.watch(1.0)]
        assert told[-1] == pytest.approx(0.1)
        peaks.append(max(abs(b - a) for a, b in zip(told, told[1:])))
    assert peaks[1] < 0.6 * peaks[0]


class Eye:
    """A robot that follows places, and how far a frame of it looks beside a place, in degrees."""

    def __init__(self, bench):
        self.bench, self.follower = bench, Follower(bench.simulation)

    def off(self, place, name="CameraTop"):
        now, frame = self.bench.now, frame_of(self.bench.model, name)
        torso = transform(quaternion_matrix(now.torso.orientation), now.torso.position)
        way = np.linalg.inv(torso @ link_transforms(self.bench.model, now.positions)[frame.link] @ frame.offset)
        way = way @ np.array((*place, 1.0))
        return math.degrees(math.acos(way[0] / np.linalg.norm(way[:3])))

    def follow(self, place, seconds=1.0):
        self.follower.follow(place)
        self.bench.run(seconds)


@pytest.fixture
def eye(bench):
    return Eye(bench())


def test_the_head_turns_to_a_place_and_follows_it_within_speed_and_acceleration(eye):
    for place in ((1.0, 0.5, 0.4), (1.0, -0.4, 0.6)):
        eye.follow(place)
        assert eye.off(place) < 1.0
    eye.follower.stop()
    eye.bench.aim(HeadYaw=0.0, HeadPitch=0.0)
    eye.bench.run(0.8)
    assert abs(eye.bench.joint("HeadYaw")) < 0.02
    eye.follower.velocity, eye.follower.head.acceleration = 0.5, 1.0
    eye.follower.follow((0.0, 1.0, 0.5))
    yaws, dt = [now.commands[0] for now in eye.bench.watch(1.0)], eye.bench.simulation.settings.tick_s
    speeds = [(b - a) / dt for a, b in zip(yaws, yaws[1:])]
    assert max(speeds) == pytest.approx(0.5, abs=0.01)
    assert max((b - a) / dt for a, b in zip(speeds, speeds[1:])) < 1.1


def test_the_whole_body_bends_for_what_is_too_low_for_the_head(eye):
    place = (0.5, 0.1, 0.05)
    eye.follow(place)
    assert eye.off(place) > 10.0
    eye.follower.mode = Tracking.WHOLE_BODY
    eye.follow(place, 3.0)
    assert eye.off(place) < 6.0 and eye.bench.robot.stability.on_feet
