"""Falls, heat, an empty battery: what ends a motion or keeps it from beginning."""

import pytest
from goal_functions import motion as f

DISABLED = "ALMotion/Protection/DisabledDevicesChanged"
STANDING, LYING = 0.28, 0.2
"""Height of the torso, m."""
HEAD = {"names": ["HeadYaw"], "angles": [0.5]}
TURN = {"names": ["HeadYaw"], "angles": [1.0], "times": [20.0]}


GET_UP = f("goToPosture", str_param="Stand")


@pytest.fixture
def height(robot):
    return lambda: robot.now.torso.position[2]


def test_a_fall_ends_the_motion_and_leaves_the_robot_limp_until_a_goal_gets_it_up(stiff_robot, motion, height):
    robot = stiff_robot
    robot.ALMotion.wakeUp(_async=True)
    robot.advance(3.0)
    goal = motion.send(f("angleInterpolation", **TURN), f("setAngles", names=["HeadPitch"], angles=[0.4]))
    robot.advance(0.5)
    robot.NaoSimulation.push([60.0, 0.0, 0.0], 0.15, "torso")
    robot.advance_until(lambda: not robot.value("robotIsWakeUp"), 5.0, what="the robot notices that it has fallen")
    goal.finish()
    text = "the robot fell and its motors are off: goToPosture gets it up again"
    assert (goal.state, goal.text) == ("aborted", f"function 1 (angleInterpolation): {text}")
    robot.advance(1.5)
    assert height() < LYING and set(robot.ALMotion.getStiffnesses("LLeg")) == {0.0}
    assert "no stiffness in HeadYaw" in motion.refused(f("setAngles", **HEAD))
    assert motion.succeed(GET_UP, f("getPosture")).memList == ["Stand"]
    assert height() > STANDING


@pytest.mark.parametrize("chain", ["Head", "Body"])
def test_a_chain_that_is_put_to_rest_ends_the_goal_that_moves_it(stiff_robot, motion, chain):
    goal = motion.send(f("angleInterpolation", **TURN))
    stiff_robot.advance(0.3)
    stiff_robot.ALMemory.raiseEvent(DISABLED, [["LArm", True], ["Head", False]])
    stiff_robot.advance(0.3)
    assert goal.active
    stiff_robot.ALMemory.raiseEvent(DISABLED, [[chain, True]])
    goal.finish()
    reason = "a motor is too hot or broken, or the battery is empty"
    assert goal.text == f"function 1 (angleInterpolation): the robot put {chain} to rest: {reason}"


def test_motors_that_are_too_hot_are_not_moved(stiff_robot, motion, angle):
    robot = stiff_robot
    robot.NaoSimulation.setTemperature("HeadYaw", 76.0)
    robot.advance(0.05)
    text = "too hot to move: HeadYaw 76 degC: rest until they are below 74 degC"
    assert text in motion.refused(f("setAngles", **HEAD))
    assert angle("HeadYaw") == pytest.approx(0.0, abs=0.03)
    motion.succeed(f("setAngles", names=["HeadPitch"], angles=[0.1]))
    robot.NaoSimulation.setTemperature("RHipRoll", 80.0)
    robot.advance(0.05)
    for function in (f("wakeUp"), GET_UP):
        assert "too hot to move: RHipRoll 80 degC" in motion.refused(function)
    assert motion.play(f("rest")).state == "succeeded", "that is never refused"


def test_an_empty_battery_moves_nothing_and_a_low_one_does_not_walk(stiff_robot, motion):
    robot = stiff_robot
    robot.NaoSimulation.setBatteryCharge(0.04)
    robot.advance(0.05)
    walk = f("moveTo", values=[0.1, 0.0, 0.0])
    assert "the battery is too low to walk (4% left): plug the charger in" in motion.refused(walk)
    motion.succeed(f("setAngles", **HEAD))
    robot.NaoSimulation.setBatteryCharge(0.01)
    robot.advance(0.05)
    for function in (f("wakeUp"), GET_UP, walk, f("setAngles", **HEAD)):
        assert "the battery is empty (1% left): plug the charger in" in motion.refused(function)
    robot.NaoSimulation.plugCharger(True)
    robot.advance(1.0)
    motion.succeed(f("setAngles", **HEAD))
