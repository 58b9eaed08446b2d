"""How walks end: by a stop at any moment, by a kill, with what they were for, at a reset."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.steps_course import Placement


def stands_still(walker):
    """Whether the robot stands, and goes on standing where it is."""
    walker.run(0.3)
    begun = walker.place()
    walker.run(1.0)
    moved = walker.place().seen_from(begun)
    return walker.stands and math.hypot(moved.x, moved.y) < 0.002 and abs(moved.yaw) < 0.005


# From the stance over the first step to the walk at full speed, at all parts of a step, s.
@pytest.mark.parametrize("moment", [0.1, 0.85, 1.0, 1.2, 1.45, 1.6, 2.5, 2.61, 2.72, 2.83])
def test_stopped_at_any_moment_it_stands_still_on_both_feet(walker, moment):
    walker.move(0.08, 0.0, 0.3)
    walker.run(moment)
    begun = walker.now.time
    stop = walker.locomotion.stop()
    walker.until(stop)
    assert walker.now.time - begun < 3.5
    assert not walker.locomotion.active
    assert stands_still(walker)
    feet = walker.feet()
    x, y, yaw = feet[LEFT].seen_from(feet[RIGHT])
    assert abs(x) < 0.02 and y == pytest.approx(0.1, abs=0.02) and abs(yaw) < 0.1
    assert walker.failures == []


@pytest.mark.parametrize("moment", [2.0, 2.15, 2.3, 2.45, 2.6])
def test_stopped_on_its_way_straight_on_its_weight_comes_to_lie_in_the_middle(walker, moment):
    walker.move_to((2.0, 0.0, 0.0))
    walker.run(moment)
    walker.until(walker.locomotion.stop())
    walker.run(0.5)
    left, right = walker.now.foot_loads
    assert left / (left + right) == pytest.approx(0.5, abs=0.05)


def test_no_velocity_at_all_ends_a_walk(walker):
    walker.move(0.06)
    walker.run(2.0)
    walker.move()
    assert walker.locomotion.active
    walker.until_it_stands()
    assert walker.stands


def test_no_velocity_at_all_begins_no_walk(walker):
    walker.move()
    assert not walker.locomotion.active


def test_a_stop_of_a_robot_that_stands_is_over_at_once(walker):
    assert walker.locomotion.stop().finished
    assert walker.locomotion.until_finished().finished


def test_what_a_stopped_walk_was_for_is_not_reached(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.0)
    waiting = walker.locomotion.until_finished()
    stop = walker.locomotion.stop()
    assert task.finished and task.value is False
    assert not waiting.finished
    walker.until(stop)
    assert waiting.finished


def test_a_walk_that_nobody_waits_for_any_more_ends_on_two_feet(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.3)
    task.kill()
    assert walker.locomotion.active
    walker.until_it_stands()
    assert stands_still(walker)


def test_a_stopped_robot_can_be_told_to_walk_on_before_it_stands(walker):
    walker.move(0.08)
    walker.run(2.5)
    walker.locomotion.stop()
    walker.run(0.6)
    assert walker.locomotion.active
    begun = walker.place()
    task = walker.move_to((0.1, 0.0, 0.0))
    assert walker.until(task) is True
    assert walker.place().seen_from(begun).x == pytest.approx(0.1, abs=0.04)


def test_killed_it_ends_in_the_same_tick(walker):
    task = walker.move_to((1.0, 0.0, 0.0))
    walker.run(2.4)
    walker.locomotion.kill()
    assert not walker.locomotion.active
    assert task.finished and task.value is False
    assert walker.robot.motion.tasks() == []
    assert walker.robot.stability.walk is None
    commands = walker.now.commands
    walker.simulation.tick()
    legs = [walker.model.joint_index[name] for leg in ("LLeg", "RLeg") for name in walker.model.chains[leg]]
    assert [walker.now.commands[i] for i in legs] == pytest.approx([commands[i] for i in legs], abs=0.02)


def test_killed_before_its_first_step_it_can_walk_again(walker):
    walker.move(0.06)
    walker.run(0.4)
    walker.locomotion.kill()
    walker.run(0.3)
    assert walker.until(walker.move_to((0.05, 0.0, 0.0))) is True


def test_a_reset_ends_a_walk_and_the_new_robot_walks(walker, walker_in):
    task = walker.move_to((1.0, 0.0, 0.0))
    waiting = walker.locomotion.until_finished()
    walker.run(2.4)
    walker.simulation.reset()
    assert task.finished and task.value is False
    assert waiting.finished
    assert walker.failures == []
    again = type(walker)(walker.bench)
    again.stiffen(1.0)
    again.run(0.3)
    assert not again.locomotion.active
    assert again.until(again.move_to((0.06, 0.0, 0.0))) is True
    assert again.stands


def test_steps_can_be_added_and_taken_back_on_the_way(walker):
    def step(side, x):
        return Placement(side, FootPose(x, side * 0.1, 0.0), 0.5)

    start = walker.place()
    first = walker.locomotion.set_steps([step(LEFT, 0.03), step(RIGHT, 0.03)], walker.GAIT, clear=False)
    second = walker.locomotion.set_steps([step(LEFT, 0.03), step(RIGHT, 0.03)], walker.GAIT, clear=False)
    assert second is first
    while len(walker.locomotion.steps().clearable) > 2:
        walker.simulation.tick()
    while not walker.locomotion.steps().fixed:
        walker.simulation.tick()
    walker.locomotion.set_steps([step(RIGHT, 0.0)], walker.GAIT, clear=True)
    assert walker.until(first) is True
    assert walker.place().seen_from(start).x == pytest.approx(0.03, abs=0.015)
