"""Waking up and resting over the network, and the events about it."""

from __future__ import annotations

import pytest

STATE = ("wakeUpStarted", "wakeUpFinished", "restStarted", "restFinished")


def raised(robot):
    """How often each event of the state has been raised."""
    return {name: len(robot.ALMemory.getEventHistory(f"ALMotion/Stiffness/{name}")) for name in STATE}


def changes(before, after):
    return {name for name in STATE if after[name] != before[name]}


def test_the_robot_boots_asleep(robot):
    assert robot.ALMotion.robotIsWakeUp() is False
    assert robot.ALMemory.getData("robotIsWakeUp") is False


def test_waking_up_stiffens_and_stands(robot):
    before = raised(robot)
    future = robot.post("ALMotion", "wakeUp")
    robot.handed_over("ALMotion")
    assert robot.ALMotion.robotIsWakeUp() is True
    assert changes(before, raised(robot)) == {"wakeUpStarted"}
    robot.advance(2.5)
    assert robot.answer(future) is None
    assert changes(before, raised(robot)) == {"wakeUpStarted", "wakeUpFinished"}
    assert robot.ALMotion.getStiffnesses("Body") == [1.0] * 26
    assert robot.now.torso.position[2] == pytest.approx(0.331, abs=0.005)
    assert robot.ALMemory.getData("robotIsWakeUp") is True


def test_resting_crouches_and_lets_go(stiff_robot):
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    before = raised(stiff_robot)
    future = stiff_robot.post("ALMotion", "rest")
    stiff_robot.handed_over("ALMotion")
    assert changes(before, raised(stiff_robot)) == {"restStarted"}
    assert stiff_robot.ALMotion.robotIsWakeUp() is True
    stiff_robot.advance(2.5)
    assert stiff_robot.answer(future) is None
    assert changes(before, raised(stiff_robot)) == {"restStarted", "restFinished"}
    assert stiff_robot.ALMotion.robotIsWakeUp() is False
    assert stiff_robot.ALMotion.getStiffnesses("Body") == [0.0] * 26
    assert stiff_robot.now.torso.position[2] == pytest.approx(0.228, abs=0.01)


def test_resting_a_chain_leaves_the_robot_awake(stiff_robot):
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    stiff_robot.finish("ALMotion", "rest", "Head", after=0.5)
    assert stiff_robot.ALMotion.getStiffnesses("Head") == [0.0, 0.0]
    assert stiff_robot.ALMotion.getStiffnesses("LArm") == [1.0] * 6
    assert stiff_robot.ALMotion.robotIsWakeUp() is True


def test_an_unknown_chain_cannot_rest(robot):
    with pytest.raises(RuntimeError, match="ALMotion::rest unknown joint or chain 'Hed': did you mean 'Head'"):
        robot.ALMotion.rest("Hed")


def test_a_killed_awakening_never_finishes(robot):
    before = raised(robot)
    future = robot.post("ALMotion", "wakeUp")
    robot.handed_over("ALMotion")
    robot.advance(1.0)
    robot.ALMotion.killAll()
    robot.answer(future)
    robot.advance(2.0)
    assert changes(before, raised(robot)) == {"wakeUpStarted"}
    assert robot.ALMotion.getTaskList() == []


def test_a_reset_puts_it_to_sleep(robot):
    robot.finish("ALMotion", "wakeUp", after=2.5)
    robot.NaoSimulation.reset()
    assert robot.ALMotion.robotIsWakeUp() is False
    assert robot.ALMotion.getStiffnesses("Body") == [0.0] * 26
