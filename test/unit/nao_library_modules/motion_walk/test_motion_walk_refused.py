"""Walks that are refused, and that nothing moves then."""

from __future__ import annotations

import math

import pytest
from motion_walk_goals import f, moved, play

from naoqi.errors import RobotError


@pytest.mark.parametrize(
    "function, text",
    [
        (f("moveTo", values=[0.3, 0.0]), "field values: 2 numbers"),
        (f("moveTo"), "field values: 0 numbers"),
        (f("moveTo", values=[math.nan, 0, 0]), "x cannot be nan"),
        (f("moveTo", values=[300, 0, 0]), "x cannot be 300: -100 to 100 m"),
        (f("moveTo", values=[0, 0, 90]), "theta cannot be 90: -3.1417 to 3.1417 rad"),
        (f("moveTo", values=[1, 0, 0], duration=-1.0), "field duration"),
        (f("moveTo", values=[1, 0, 0, 2, 0, 0], duration=5.0), "places on the way"),
        (f("moveTo", values=[1, 0, 0], gait=["MaxStepx"], gait_values=[0.04]), "did you mean 'MaxStepX'"),
        (f("moveTo", values=[1, 0, 0], gait=["MinStepPeriod"], gait_values=[0.3]), "is no parameter of a walk"),
        (f("moveTo", values=[1, 0, 0], gait=["LeftStepHeight"], gait_values=[0.02]), "for move and moveToward"),
        (f("moveTo", values=[1, 0, 0], gait=["StepHeight"], gait_values=[0.04]), "StepHeight cannot be 0.04: 0.005 to"),
        (f("moveTo", values=[1, 0, 0], gait=["StepHeight"], gait_values=[math.nan]), "StepHeight cannot be nan"),
        (f("moveTo", values=[1, 0, 0], gait=["StepHeight"]), "0 values for 1 parameters"),
        (f("move", values=[0.1, 0]), "x, y (m/s) and theta (rad/s)"),
        (f("move", values=[10.0, 0, 0]), "x cannot be 10"),
        (f("moveToward", values=[0, -1.1, 0]), "y cannot be -1.1: -1 to 1"),
        (f("moveToward", values=[0, 0, 1], gait=["Frequency"], gait_values=[2.0]), "Frequency cannot be 2: 0 to 1"),
        (f("walkTarget", values=[1, 0, 0, 2, 0, 0]), "6 numbers"),
        (f("walkTarget", values=[1, 0, 0], frame=3), "field frame"),
        (f("walkPath", values=[1, 0, math.inf], frame=1), "theta cannot be inf"),
        (f("walkTarget", values=[1, 0, 0], str_param="chair"), "the frame chair cannot be found"),
        (f("setFootSteps", names=["LArm"], values=[0, 0.1, 0], times=[1.0]), "LLeg, RLeg"),
        (f("setFootSteps", names=["LLeg"], values=[0, 0.1], times=[1.0]), "2 numbers for 1 steps"),
        (f("setFootSteps", names=["LLeg"] * 2, values=[0, 0.1, 0] * 2, times=[1.0, 2.0]), "cannot step twice"),
        (f("setFootSteps", names=["LLeg"], values=[0, -0.1, 0], times=[1.0]), "y of a step of LLeg cannot be -0.1"),
        (f("setFootSteps", names=["RLeg"], values=[0.1, -0.1, 0], times=[1.0]), "x of a step of RLeg cannot be 0.1"),
        (f("setFootSteps", names=["RLeg"], values=[0, -0.1, 0], times=[1.0, 2.0]), "2 times for 1 steps"),
        (f("setFootStepsWithSpeed", names=["RLeg"], values=[0, -0.1, 0], speed=2.0), "above 0 to 1"),
        (f("getMoveConfig", str_param="Mox"), "'Mox' is not known: did you mean 'Max'"),
        (f("setMoveArmsEnabled", names=["LLeg"]), "LArm, RArm"),
        (f("setOrthogonalSecurityDistance", values=[-0.1]), "0 to 2.5 m"),
    ],
)
def test_what_is_wrong_is_told_and_nothing_moves(motion, robot, function, text):
    server = play(motion, f("moveTo", values=[0.1, 0, 0]), function)
    assert server.end == "aborted"
    assert server.text.startswith("function 2") and text in server.text
    assert moved(robot) == []


def test_a_bad_goal_does_not_stop_the_walk_of_the_goal_before(motion, fake):
    play(motion, f("move", values=[0.1, 0, 0]))
    assert play(motion, f("moveTo", values=[math.nan, 0, 0])).end == "aborted"
    assert fake.walking


@pytest.mark.parametrize(
    "stiffness, text", [(0.0, "the legs are limp: wakeUp first"), (0.5, "RHipRoll has stiffness 0.50")]
)
def test_nobody_walks_on_limp_or_soft_legs(motion, fake, robot, stiffness, text):
    fake.stiffnesses["RHipRoll"] = stiffness
    server = play(motion, f("moveTo", values=[0.1, 0, 0]))
    assert server.end == "aborted" and text in server.text
    assert moved(robot) == []
    assert play(motion, f("wakeUp"), f("moveTo", values=[0.1, 0, 0])).end == "succeeded"
    server = play(motion, f("rest"), f("moveTo", values=[0.1, 0, 0]))
    assert server.end == "aborted" and "the legs are limp" in server.text


def test_nobody_walks_from_the_floor(motion, robot):
    robot.proxy("ALRobotPosture")._service.posture = "Sit"
    server = play(motion, f("setAngles", names=["HeadYaw"], angles=[0.1]), f("move", values=[0.1, 0, 0]))
    assert server.end == "aborted" and "(posture Sitting): goToPosture Stand first" in server.text
    assert moved(robot) == []
    assert play(motion, f("goToPosture", str_param="Stand"), f("moveTo", values=[0.1, 0, 0])).end == "succeeded"
    server = play(motion, f("goToPosture", str_param="Sit"), f("moveTo", values=[0.1, 0, 0]))
    assert server.end == "aborted" and "(posture Sit)" in server.text


def test_a_robot_that_walks_or_has_moved_its_legs_is_not_asked_for_its_posture(motion, fake, robot):
    robot.proxy("ALRobotPosture")._service.posture = "Sit"
    assert play(motion, LEG, f("moveTo", values=[0.1, 0, 0])).end == "succeeded"
    fake.walking = True
    assert play(motion, f("move", values=[0.1, 0, 0])).end == "succeeded"
    assert robot.proxy("ALRobotPosture").calls == []


LEG = f("angleInterpolation", names=["LHipRoll"], angles=[0.1], times=[1.0])


@pytest.mark.parametrize(
    "between, good",
    [
        ([], False),
        ([f("setAngles", names=["HeadYaw"], angles=[0.1])], False),
        ([f("stopMove")], True),
        ([f("waitUntilMoveIsFinished")], True),
        ([f("goToPosture", str_param="Stand")], True),
        ([f("killAll")], True),
        ([f("wakeUp")], True),
    ],
)
def test_joints_of_a_walking_leg_are_not_moved(motion, robot, between, good):
    server = play(motion, f("move", values=[0.1, 0, 0]), *between, LEG)
    if good:
        assert server.end == "succeeded", server.text
    else:
        assert server.end == "aborted" and "the robot walks, and LHipRoll with it: stopMove" in server.text
        assert moved(robot) == []


def test_the_walk_of_an_earlier_goal_counts(motion, fake):
    fake.walking = True
    assert "the robot walks" in play(motion, LEG).text
    assert play(motion, f("setAngles", names=["HeadYaw"], angles=[0.1])).end == "succeeded"


def test_a_refusal_of_the_robot_is_told(motion, fake, monkeypatch):
    def refuse(*_):
        raise RobotError("ALMotion", "moveTo", "no contact of the feet with the ground")

    monkeypatch.setattr(fake, "moveTo", refuse)
    server = play(motion, f("moveTo", values=[0.1, 0, 0]))
    assert server.end == "aborted" and "no contact of the feet" in server.text


def test_a_dry_run_tells_how_long_walks_take(motion, robot):
    functions = [f("moveTo", values=[0.4, 0, 0]), f("moveTo", values=[0.4, 0, 0], duration=60.0)]
    functions += [f("move", values=[0.1, 0, 0], duration=3.0, dry_run=True)]
    server = play(motion, *functions)
    assert server.end == "succeeded", server.text
    forward, slowly, for_a_while = (float(entry.values[0]) for entry in server.result.results)
    assert 5.0 < forward < 8.0
    assert (slowly, for_a_while) == (60.0, 3.0)
    assert moved(robot) == []


def test_arms_that_swing_again_after_their_motion_were_not_stopped(motion, fake):
    wave = f("setPose", names=["LShoulderPitch"], angles=[0.5], duration=1.0)
    fake.walking = True
    fake.angleInterpolation = lambda *_: fake.angles.update(LShoulderPitch=1.3)
    assert play(motion, wave).end == "succeeded"
    fake.walking = False
    server = play(motion, wave)
    assert server.end == "aborted" and "LShoulderPitch got to 1.300" in server.text
