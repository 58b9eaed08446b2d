"""What keeps a robot from walking, and what ends a walk before its time."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.errors import MoveRefused
from nao_sim_bridge.sim.walk.walk_guard import CONTACT_SWITCH, STIFFNESS_SWITCH

LEG_JOINTS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
LEGS = [f"{side}{name}" for side in "LR" for name in LEG_JOINTS]


def refused(walker):
    """The text with which a move was refused."""
    with pytest.raises(MoveRefused) as error:
        walker.move(0.05)
    assert not walker.locomotion.active
    assert walker.robot.motion.tasks() == []
    assert [(started, obstacle) for _, started, obstacle in walker.failures] == [(False, None)]
    assert walker.failures[0][0] in str(error.value)
    return str(error.value)


# --- it does not begin --------------------------------------------------------------------------------------------


def test_limp_legs_do_not_walk(walker_in):
    walker = walker_in("Crouch", stiffness=0.0)
    text = refused(walker)
    assert "stiffness" in text and "LHipYawPitch" in text and "wakeUp" in text


def test_one_soft_joint_is_enough_and_is_named(walker):
    walker.stiffen(0.6, "RAnkleRoll")
    text = refused(walker)
    assert "RAnkleRoll" in text and "LAnkleRoll" not in text


def test_stiff_enough_is_stiff_enough(walker):
    walker.stiffen(0.7, *LEGS)
    assert walker.until(walker.move_to((0.04, 0.0, 0.0))) is True


@pytest.mark.parametrize("posture", ["Sit", "LyingBack"])
def test_who_does_not_stand_does_not_walk(walker_in, posture):
    walker = walker_in(posture)
    walker.run(0.5)
    refused(walker)


@pytest.mark.parametrize("call", ["move_to", "steps", "init", "toward"])
def test_every_kind_of_move_is_refused(walker, call):
    walker.stiffen(0.0, *LEGS)
    locomotion = walker.locomotion
    calls = {
        "move_to": lambda: walker.move_to((0.1, 0.0, 0.0)),
        "steps": lambda: locomotion.set_steps([], walker.GAIT, clear=False),
        "init": locomotion.init,
        "toward": lambda: locomotion.move_toward(1.0, 0.0, 0.0, walker.GAIT),
    }
    with pytest.raises(MoveRefused, match="stiffness"):
        calls[call]()
    assert not locomotion.active


# --- it ends ------------------------------------------------------------------------------------------------------


def walk_fails(walker, task):
    """The cause with which a walk that has begun fails, by the time at which its task has ended."""
    assert walker.until(task) is False
    assert not walker.locomotion.active
    assert len(walker.failures) == 1
    cause, started, obstacle = walker.failures[0]
    assert started and obstacle is None
    return cause


def test_legs_that_become_soft_end_a_walk_at_once(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.0)
    walker.stiffen(0.5, "LKneePitch")
    walker.simulation.tick()
    assert task.finished
    assert "LKneePitch" in walk_fails(walker, task)


def test_without_the_protection_soft_legs_walk_on(walker):
    walker.robot.reflexes.switches[STIFFNESS_SWITCH] = False
    walker.stiffen(0.6, *LEGS)
    walker.move(0.04)
    walker.run(1.5)
    assert walker.locomotion.active
    assert walker.failures == []


def lift(walker):
    """Somebody takes the robot up, for half a second."""
    weight = walker.model.total_mass * 9.81
    walker.push((0.0, 0.0, 1.2 * weight), 0.5)


def test_a_robot_that_is_lifted_stops_walking(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.0)
    begun = walker.now.time
    lift(walker)
    assert "ground" in walk_fails(walker, task)
    assert walker.now.time - begun < 0.5


def test_a_robot_in_the_air_does_not_begin_to_walk(walker):
    lift(walker)
    walker.run(0.3)
    assert "no ground" in refused(walker)


def test_a_robot_that_falls_walks_no_more(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.5)
    walker.push((0.0, 70.0, 0.0), 0.12)
    assert "fall" in walk_fails(walker, task)
    assert walker.robot.stability.falls.falling
    with pytest.raises(MoveRefused, match="falling"):
        walker.move(0.05)


# --- it goes on ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("force", [(10.0, 0.0, 0.0), (-10.0, 0.0, 0.0), (0.0, 10.0, 0.0), (0.0, -10.0, 0.0)])
def test_a_push_on_the_way_does_not_keep_it_from_arriving(walker, force):
    start = walker.locomotion.position(use_sensors=True)
    task = walker.move_to((0.2, 0.0, 0.0))
    walker.run(2.6)
    walker.push(force, 0.1)
    assert walker.until(task) is True
    x, y, yaw = walker.locomotion.position(use_sensors=True).seen_from(start)
    assert math.hypot(x - 0.2, y) < 0.02 and abs(yaw) < 0.06
    assert walker.failures == []


def test_it_steps_on_a_low_plate_and_off_it(walker_in, world_file):
    bump = "{name: plate, box: [0.04, 0.6, 0.004], position: [0.14, 0.0, 0.002], mass: 0}"
    walker = walker_in("StandInit", world=world_file(bump))
    assert walker.until(walker.move_to((0.25, 0.0, 0.0))) is True
    assert walker.stands


def test_the_lifted_switch_is_looked_at(walker):
    walker.robot.reflexes.switches[CONTACT_SWITCH] = False
    walker.move(0.04)
    walker.run(2.0)
    lift(walker)
    walker.run(0.35)
    assert walker.failures == []
    assert walker.locomotion.active
