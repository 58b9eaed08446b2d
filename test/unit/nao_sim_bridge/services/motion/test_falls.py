"""Fall manager and push recovery over the network, and the events about falls."""

from __future__ import annotations

import pytest

FALLING, FALLEN, STANDS, AWAKE = "ALMotion/RobotIsFalling", "robotHasFallen", "ALMotion/RobotIsStand", "robotIsWakeUp"
FORWARD = [60.0, 0.0, 0.0]
# That of the owner to do without the fall manager.
PERMISSION = [["ENABLE_DEACTIVATION_OF_FALL_MANAGER", True]]


def raised(robot):
    """How often each event of a fall has been raised."""
    return [len(robot.ALMemory.getEventHistory(event)) for event in (FALLING, FALLEN)]


def fall(robot, seconds=4.0):
    """Push the robot over; what events that raised."""
    before = raised(robot)
    robot.NaoSimulation.push(FORWARD, 0.1, "torso")
    robot.advance(seconds)
    return [after - earlier for earlier, after in zip(before, raised(robot))]


@pytest.fixture
def standing(stiff_robot):
    """The robot, stiff, that has stood for a while."""
    stiff_robot.advance(1.0)
    return stiff_robot


@pytest.mark.parametrize("what", ["FallManager", "PushRecovery"])
def test_both_are_on_after_the_start_and_can_be_switched(robot, what):
    def state():
        return robot.ALMotion.call(f"get{what}Enabled")

    assert state() is True
    robot.ALMotion.setMotionConfig(PERMISSION)
    robot.ALMotion.call(f"set{what}Enabled", False)
    assert state() is False
    robot.ALMotion.call(f"set{what}Enabled", True)
    assert state() is True


@pytest.mark.parametrize("what", ["FallManager", "PushRecovery"])
def test_a_restart_switches_them_on(robot, what):
    robot.ALMotion.setMotionConfig(PERMISSION)
    robot.ALMotion.call(f"set{what}Enabled", False)
    robot.NaoSimulation.reset()
    assert robot.ALMotion.call(f"get{what}Enabled") is True


def test_a_fall_is_told_when_it_begins_and_when_it_is_over(standing):
    assert fall(standing, 0.5) == [1, 0]
    assert standing.ALMemory.getData(FALLING) is True
    before = raised(standing)
    standing.advance(3.5)
    assert [after - earlier for earlier, after in zip(before, raised(standing))] == [0, 1]
    assert standing.ALMemory.getData(FALLEN) is True


def test_after_a_fall_the_robot_is_limp_and_asleep(robot):
    robot.finish("ALMotion", "wakeUp", after=3.0)
    assert robot.ALMotion.robotIsWakeUp() is True
    assert fall(robot) == [1, 1]
    assert robot.ALMotion.getStiffnesses("Body") == [0.0] * 26
    assert robot.ALMotion.robotIsWakeUp() is False
    assert robot.ALMemory.getData(AWAKE) is False


def test_a_fall_ends_the_calls_that_move_the_robot(standing):
    future = standing.post("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 30.0, True)
    standing.handed_over("ALMotion")
    standing.advance(0.1)
    assert fall(standing) == [1, 1]
    standing.answer(future)
    assert standing.ALMotion.getTaskList() == []


def test_the_fall_manager_stays_on_without_permission(standing):
    with pytest.raises(RuntimeError, match="ENABLE_DEACTIVATION_OF_FALL_MANAGER"):
        standing.ALMotion.setFallManagerEnabled(False)
    assert standing.ALMotion.getFallManagerEnabled() is True


def test_a_fall_manager_that_is_off_says_nothing_and_does_nothing(standing):
    standing.ALMotion.setMotionConfig(PERMISSION)
    standing.ALMotion.setFallManagerEnabled(False)
    assert fall(standing) == [0, 0]
    assert standing.now.torso.position[2] < 0.15
    assert standing.ALMotion.getStiffnesses("Body") == [1.0] * 26


def test_standing_is_told_when_it_changes(standing):
    assert standing.ALMemory.getData(STANDS) is True
    before = len(standing.ALMemory.getEventHistory(STANDS))
    fall(standing)
    history = standing.ALMemory.getEventHistory(STANDS)
    assert standing.ALMemory.getData(STANDS) is False
    assert len(history) == before + 1


@pytest.mark.parametrize("enabled", [True, False])
def test_push_recovery_keeps_the_robot_on_its_feet(standing, enabled):
    standing.ALMotion.setPushRecoveryEnabled(enabled)
    standing.NaoSimulation.push([-20.0, 0.0, 0.0], 0.1, "torso")
    standing.advance(3.0)
    assert (standing.now.torso.position[2] > 0.3) is enabled
