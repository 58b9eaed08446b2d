"""How walks end: by a stop at any moment, a kill, what they were for, a reset; what forbids and what ends them."""

import pytest

from nao_sim_bridge.base.errors import MovePrevented, MoveRefused
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.walk_guard import CONTACT_SWITCH, STIFFNESS_SWITCH

LEG_JOINTS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
LEGS = [f"{side}{name}" for side in "LR" for name in LEG_JOINTS]


# From the stance over the first step to the walk at full speed, at all parts of a step, s.
@pytest.mark.parametrize("moment", [0.1, 0.85, 2.61])
def test_stopped_at_any_moment_it_stands_still_on_both_feet(walker, moment):
    walker.move(0.08, 0.0, 0.3)
    walker.run(moment)
    begun = walker.now.time
    walker.until(walker.locomotion.stop())
    assert walker.now.time - begun < 1.6
    assert not walker.locomotion.active and walker.failures == []
    assert walker.stands_still()
    feet = walker.feet()
    x, y, yaw = feet[LEFT].seen_from(feet[RIGHT])
    assert (x, y, yaw) == pytest.approx((0.0, 0.1, 0.0), abs=0.005)


def test_a_reset_ends_a_walk(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    waiting = walker.locomotion.until_finished()
    walker.run(2.4)
    walker.simulation.reset()
    assert task.finished and task.value is False and waiting.finished
    assert walker.failures == []


def refused(walker):
    """The text with which a move was refused."""
    with pytest.raises(MoveRefused) as error:
        walker.move(0.05)
    assert not walker.locomotion.active
    assert walker.robot.motion.tasks() == []
    assert [(started, obstacle) for _, started, obstacle in walker.failures] == [(False, None)]
    assert walker.failures[0][0] in str(error.value)
    return str(error.value)


def test_one_soft_joint_is_enough_for_every_kind_of_move_and_is_named(walker):
    walker.stiffen(0.7, *LEGS)
    walker.stiffen(0.6, "RAnkleRoll")
    text = refused(walker)
    assert "RAnkleRoll" in text and "LAnkleRoll" not in text
    locomotion = walker.locomotion
    for call in (
        lambda: walker.move_to((0.1, 0.0, 0.0)),
        locomotion.init,
        lambda: locomotion.move_toward(1.0, 0.0, 0.0, walker.GAIT),
    ):
        with pytest.raises(MoveRefused, match="stiffness of RAnkleRoll"):
            call()
    assert not locomotion.active
    walker.stiffen(0.7, "RAnkleRoll")
    assert walker.until(walker.move_to((0.04, 0.0, 0.0))) is True, "stiff enough is stiff enough"


@pytest.mark.parametrize("posture, family", [("Sit", "Sitting"), ("LyingBack", "LyingBack")])
def test_who_does_not_stand_does_not_walk(walker_in, posture, family):
    walker = walker_in(posture)
    walker.run(0.5)
    assert f"is {family}, it walks only from standing or crouching" in refused(walker)


def walk_fails(walker, task):
    """The cause with which a walk that has begun fails, by the time at which its task has ended."""
    assert walker.until(task) is False
    assert not walker.locomotion.active
    ((cause, started, obstacle),) = walker.failures
    assert started and obstacle is None
    return cause


def lift(walker):
    """Somebody takes the robot up, for half a second."""
    walker.push((0.0, 0.0, 1.2 * walker.model.total_mass * 9.81), 0.5)


def test_legs_that_become_soft_end_a_walk_at_once(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.0)
    walker.stiffen(0.5, "LKneePitch")
    walker.simulation.tick()
    assert task.finished
    assert "LKneePitch" in walk_fails(walker, task)


def test_a_robot_that_is_lifted_stops_walking_and_in_the_air_begins_no_walk(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.0)
    begun = walker.now.time
    lift(walker)
    assert "lost the ground" in walk_fails(walker, task)
    assert walker.now.time - begun == pytest.approx(0.24, abs=0.04)
    walker.failures.clear()
    assert "no ground" in refused(walker)


def test_without_protections_soft_legs_and_a_lifted_robot_walk_on(walker):
    for switch in (STIFFNESS_SWITCH, CONTACT_SWITCH):
        walker.robot.reflexes.switches[switch] = False
    walker.stiffen(0.6, *LEGS)
    walker.move(0.04)
    walker.run(1.5)
    lift(walker)
    walker.run(0.35)
    assert walker.locomotion.active and walker.failures == []


def test_a_robot_that_falls_walks_no_more(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.5)
    walker.push((0.0, 70.0, 0.0), 0.12)
    assert "fall" in walk_fails(walker, task)
    assert walker.robot.stability.falls.falling
    walker.stiffen(0.0)  # as the robot does then
    with pytest.raises(MoveRefused, match="falling") as refusal:
        walker.move(0.05)
    assert not isinstance(refusal.value, MovePrevented)
