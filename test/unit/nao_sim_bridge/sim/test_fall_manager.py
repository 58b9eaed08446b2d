"""Falls are noticed in time and made gentle; what is no fall raises no alarm."""

from __future__ import annotations

import json
import math

import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim import fall_manager as module
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.fall_manager import FILE, FallState, load_fall_settings
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion import sequences
from nao_sim_bridge.sim.motion.sequences import posture_task
from nao_sim_bridge.sim.postures import posture

SIDES = {"front": (1, 0), "back": (-1, 0), "left": (0, 1), "right": (0, -1)}
STANDING = ("Stand", "StandInit", "StandZero", "Crouch")
BODY = ("torso", "Head", "LBicep", "RBicep")
# Noticed this long before the body hits the floor, s.
LEAST_LEAD = 0.2


def ticks(one, seconds):
    """Each snapshot of the next `seconds` as it comes, so that the robot can be looked at in between."""
    for _ in range(round(seconds / one.simulation.settings.tick_s)):
        yield one.simulation.tick()


def shove(one, side, force=60.0):
    x, y = SIDES[side]
    one.push((force * x, force * y, 0.0), 0.1)


def falls(one):
    return one.robot.stability.falls


def states(one, seconds):
    """States that the fall manager goes through, in order."""
    seen = [falls(one).state]
    for _ in ticks(one, seconds):
        if falls(one).state is not seen[-1]:
            seen.append(falls(one).state)
    return seen


@pytest.fixture
def watched(bench):
    """Makes simulations whose robot has stood for a while."""

    def make(posture="Stand", **scene):
        one = bench(posture, **scene)
        one.run(0.8)
        assert falls(one).state is FallState.WATCHING
        return one

    return make


# --- falls ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("side", SIDES)
def test_a_fall_is_noticed_well_before_the_impact(watched, side):
    one = watched()
    shove(one, side)
    noticed = impact = None
    for snapshot in ticks(one, 3.0):
        if noticed is None and falls(one).falling:
            noticed = snapshot.time
        if impact is None and any(one.robot.link_name(contact.link) in BODY for contact in snapshot.contacts):
            impact = snapshot.time
    assert noticed is not None
    assert impact is None or impact - noticed > LEAST_LEAD
    x, y = SIDES[side]
    assert falls(one).direction[0] * x + falls(one).direction[1] * y > 0.8


@pytest.mark.parametrize("side", SIDES)
def test_a_fall_ends_limp_and_lying(watched, side):
    one = watched()
    shove(one, side)
    assert states(one, 4.0) == [FallState.WATCHING, FallState.FALLING, FallState.FALLEN]
    assert set(one.now.stiffnesses) == {0.0}
    assert one.now.torso.position[2] < 0.15
    assert math.hypot(*one.now.imu.gyroscope) < 0.5


def test_motors_let_go_before_the_body_hits_the_floor(watched):
    one = watched()
    shove(one, "front")
    for snapshot in ticks(one, 3.0):
        if any(one.robot.link_name(contact.link) in BODY for contact in snapshot.contacts):
            break
    assert max(snapshot.stiffnesses) == 0.0


def test_hands_come_forward_and_the_head_back_in_a_fall_on_the_face(watched):
    one = watched()
    shove(one, "front")
    while max(one.now.stiffnesses) > 0.0:
        one.simulation.tick()
    assert one.joint("LShoulderPitch") < 0.6
    assert one.joint("RShoulderPitch") < 0.6
    assert one.joint("HeadPitch") < -0.3


@pytest.mark.parametrize("side, arm, other", [("left", "L", "R"), ("right", "R", "L")])
def test_the_lower_arm_is_drawn_in_in_a_fall_to_a_side(watched, side, arm, other):
    one = watched()
    shove(one, side)
    while max(one.now.stiffnesses) > 0.0:
        one.simulation.tick()
    assert abs(one.joint(f"{arm}ElbowRoll")) > 1.2
    assert abs(one.joint(f"{other}ElbowRoll")) < 0.6


@pytest.mark.parametrize("side, part, share", [("front", "torso", 0.5), ("back", "Head", 0.2)])
def test_the_body_hits_the_floor_less_hard_than_without(watched, side, part, share):
    def hardest(enabled):
        one = watched()
        falls(one).enabled = enabled
        shove(one, side)
        forces = [0.0]
        for snapshot in ticks(one, 2.5):
            hits = [contact.force for contact in snapshot.contacts if one.robot.link_name(contact.link) == part]
            forces.append(sum(hits))
        return max(forces)

    assert hardest(enabled=True) < share * hardest(enabled=False)


def test_a_fall_ends_every_motion(watched):
    one = watched()
    indices = [one.model.joint_index["HeadYaw"]]
    task = one.robot.motion.follow("test", indices, lambda now: {i: sequences.Ramp(now[i], 1.0, 0.01) for i in indices})
    shove(one, "back")
    while not falls(one).falling:
        one.simulation.tick()
    assert task.killed
    assert one.robot.motion.tasks() == []


def test_legs_that_walk_out_from_under_the_body_make_a_fall(watched):
    one = watched("StandInit")
    one.aim(2.0, LAnklePitch=-0.9, RAnklePitch=-0.9)
    assert FallState.FALLING in states(one, 2.0)


# --- what is no fall --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("side", SIDES)
def test_a_push_that_is_survived_is_no_fall(watched, side):
    one = watched()
    shove(one, side, force=20.0)
    assert states(one, 2.5) == [FallState.WATCHING]


def test_waking_up_and_going_to_rest_is_no_fall(bench):
    one = bench("Crouch", 0.0)
    for change in (sequences.wake_up, sequences.rest) * 2:
        change(one.robot, lambda: one.now, lambda: None)
        assert FallState.FALLING not in states(one, 2.5)
    assert falls(one).state is FallState.RESTING


@pytest.mark.parametrize("start", STANDING)
def test_changing_posture_is_no_fall(watched, start):
    one = watched(start)
    for target in STANDING:
        posture_task(one.robot, "test", target, duration=1.0)
        assert states(one, 1.3) == [FallState.WATCHING]


def test_fast_arms_are_no_fall(watched):
    one = watched("StandInit")
    for turn in range(6):
        angle = (-1.2, 1.4)[turn % 2]
        one.aim(8.0, LShoulderPitch=angle, RShoulderPitch=-angle)
        assert states(one, 0.4) == [FallState.WATCHING]


def test_standing_on_one_foot_is_no_fall(watched):
    one = watched()
    one.aim(0.5, LHipRoll=-0.38, RHipRoll=-0.38, LAnkleRoll=0.36, RAnkleRoll=0.36)
    assert states(one, 1.5) == [FallState.WATCHING]
    one.aim(1.0, RKneePitch=0.6, RHipPitch=-0.3, RAnklePitch=-0.3)
    assert states(one, 2.5) == [FallState.WATCHING]
    assert one.now.right_foot.total == 0.0


def test_a_limp_robot_that_collapses_does_not_fall(watched):
    one = watched("StandInit")
    one.stiffen(0.0)
    assert states(one, 2.0)[-1] is FallState.RESTING
    assert FallState.FALLING not in states(one, 1.0)


def test_one_that_gets_up_does_not_fall(watched):
    one = watched()
    one.robot.getting_up = True
    shove(one, "front")
    assert FallState.FALLING not in states(one, 2.0)
    assert one.now.torso.position[2] < 0.15
    assert min(one.now.stiffnesses) == 1.0


# --- off and on -------------------------------------------------------------------------------------------------------


def test_one_that_is_switched_off_leaves_the_robot_stiff(watched):
    one = watched()
    falls(one).enabled = False
    shove(one, "front")
    assert states(one, 2.0) == [FallState.RESTING]
    assert one.now.torso.position[2] < 0.15
    assert min(one.now.stiffnesses) == 1.0


def test_after_a_fall_it_watches_again_when_the_robot_stands(watched):
    one = watched()
    shove(one, "front")
    assert states(one, 4.0)[-1] is FallState.FALLEN
    one.stiffen(1.0)
    assert states(one, 1.0) == [FallState.FALLEN]
    stand = posture(one.model, "Stand")
    one.robot.joints.hold(stand, range(26))
    one.simulation._physics.place(stand)
    assert states(one, 1.5) == [FallState.FALLEN, FallState.WATCHING]
    shove(one, "back")
    assert FallState.FALLING in states(one, 1.0)


# --- the file ---------------------------------------------------------------------------------------------------------


def test_a_pose_of_an_unknown_joint_is_refused(tmp_path, monkeypatch):
    content = json.loads(config_file(FILE).read_text())
    content["protect"]["front"]["LElbow"] = 0.0
    path = tmp_path / FILE
    path.write_text(json.dumps(content))
    monkeypatch.setattr(module, "config_file", lambda name: path)
    with pytest.raises(ConfigError, match=f"{FILE}: protect.front: no joint 'LElbow'"):
        load_fall_settings(load_model())


@pytest.mark.parametrize("side", SIDES)
def test_one_that_is_knocked_off_its_feet_has_fallen_when_it_lies(watched, side):
    one = watched("StandInit")
    x, y = SIDES[side]
    one.push((60.0 * x, 60.0 * y, 0.0), 0.15)
    assert states(one, 4.0) == [FallState.WATCHING, FallState.FALLING, FallState.FALLEN]
