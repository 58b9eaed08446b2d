"""The motion module on a robot that is hot, has an empty battery, or puts chains to rest."""

from __future__ import annotations

import pytest

from nao_library_actions.msg import NaoMotionGoal
from nao_library_modules.body_devices import CHARGE, PREFIX
from nao_library_msgs.msg import MotionFunction

LIMIT = 5.0
DISABLED = "ALMotion/Protection/DisabledDevicesChanged"


@pytest.fixture
def warm(robot):
    return lambda joint, celsius: robot.memory.data.update({f"{PREFIX}{joint}/Temperature/Sensor/Value": celsius})


def f(function, **fields):
    return MotionFunction(function=function, **fields)


def play(motion, *functions):
    return motion.server.play(NaoMotionGoal(list(functions)))


HEAD = {"names": ["HeadYaw"], "angles": [0.5]}


@pytest.mark.parametrize(
    "function",
    [
        f("setAngles", **HEAD),
        f("angleInterpolation", times=[1.0], **HEAD),
        f("angleInterpolationWithSpeed", **HEAD),
        f("setPose", **HEAD),
    ],
)
def test_a_motor_that_is_too_hot_is_not_moved(motion, fake, warm, function):
    warm("HeadYaw", 76.0)
    server = play(motion, function)
    assert server.end == "aborted"
    assert "too hot to move: HeadYaw 76 degC: rest until they are below 74 degC" in server.text
    assert fake.angles["HeadYaw"] == 0.0


def test_a_hot_motor_is_moved_at_half_speed(motion, robot, warm):
    warm("HeadYaw", 70.0)
    assert play(motion, f("setAngles", speed=0.9, **HEAD), f("setPose", speed=0.2, **HEAD)).end == "succeeded"
    calls = {call[0]: call[-1] for call in robot.proxy("ALMotion").calls}
    assert calls["setAngles"] == 0.5
    assert calls["angleInterpolationWithSpeed"] == pytest.approx(0.2)


@pytest.mark.parametrize(
    "function",
    [f("wakeUp"), f("goToPosture", str_param="Stand"), f("moveTo", values=[0.1, 0.0, 0.0]), f("setAngles", **HEAD)],
)
def test_an_empty_battery_moves_nothing(motion, robot, function):
    robot.memory.data[CHARGE] = 0.01
    server = play(motion, function)
    assert server.end == "aborted"
    assert "the battery is empty (1% left): plug the charger in" in server.text


def test_resting_is_never_refused(motion, robot, warm):
    robot.memory.data[CHARGE] = 0.0
    warm("LHipRoll", 90.0)
    assert play(motion, f("rest")).end == "succeeded"


def test_with_hot_legs_nobody_wakes_up_but_with_a_hot_arm(motion, warm):
    warm("LShoulderRoll", 80.0)
    assert play(motion, f("wakeUp")).end == "succeeded"
    warm("RHipRoll", 80.0)
    assert "too hot to move: RHipRoll 80 degC" in play(motion, f("wakeUp")).text


@pytest.mark.parametrize("chain", ["Head", "Body"])
def test_a_chain_that_is_put_to_rest_ends_the_goal_that_moves_it(motion, fake, robot, chain):
    fake.slow.add("angleInterpolation")
    function = f("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[5.0])
    thread = motion.server.play_in_background(NaoMotionGoal([function]))
    assert fake.started.wait(LIMIT)
    robot.memory.signals[DISABLED]([["LArm", True], ["Head", False]])
    assert not motion.interrupt.is_set()
    robot.memory.signals[DISABLED]([[chain, True]])
    thread.join(LIMIT)
    assert motion.server.end == "aborted"
    assert motion.server.text == (
        f"function 1 (angleInterpolation): the robot put {chain} to rest: a motor is too hot or broken, or the "
        "battery is empty"
    )
