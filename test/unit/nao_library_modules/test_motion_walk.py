"""Walking functions on a stand-in for ALMotion: what is called, what is refused, and that every end is on two feet."""

from __future__ import annotations

import json
import math
import threading

import pytest
from fake_motion import CHAINS, FakeMotion, FakePostures
from genpy import Duration

from nao_library_actions.msg import NaoMotionGoal
from nao_library_modules.errors import Preempted
from nao_library_msgs.msg import MotionFunction
from naoqi.errors import RobotError

LIMIT = 5.0
STOP = ("stopMove",), ("waitUntilMoveIsFinished",)


@pytest.fixture
def fake(robot, make_call):
    fake = FakeMotion(make_call)
    robot.add("ALMotion", fake)
    robot.add("ALRobotPosture", FakePostures())
    return fake


@pytest.fixture
def motion(robot, edge, fake, tmp_path):
    from nao_library_modules.motion import NaoMotion

    return NaoMotion("10.0.0.7", 9559, robot=robot, edge=edge, motion_dir=tmp_path)


def f(function, **fields):
    return MotionFunction(function=function, **fields)


def play(motion, *functions):
    return motion.server.play(NaoMotionGoal(list(functions)))


def play_until(motion, event, *functions):
    """Play a chain in the background until an event; the thread that plays it."""
    thread = motion.server.play_in_background(NaoMotionGoal(list(functions)))
    assert event.wait(LIMIT)
    return thread


def moved(robot):
    """Calls that change something, in order."""
    asking = ("get", "robotIs", "moveIs")
    return [call for call in robot.proxy("ALMotion").calls if not call[0].startswith(asking)]


# Walks to places


def test_a_walk_to_a_place_answers_how_far_it_got(motion, fake, robot):
    fake.place = [1.0, 2.0, math.pi / 2]
    server = play(motion, f("moveTo", values=[0.3, 0.1, 0.5]))
    assert server.end == "succeeded", server.text
    assert moved(robot) == [("moveTo", 0.3, 0.1, 0.5)]
    assert [float(v) for v in server.result.memList] == pytest.approx([0.3, 0.1, 0.5])
    assert fake.place == pytest.approx([0.9, 2.3, math.pi / 2 + 0.5])


def test_time_and_gait_of_a_walk_go_to_the_robot_in_its_shape(motion, robot):
    play(motion, f("moveTo", values=[0.3, 0, 0], duration=20.0))
    play(motion, f("moveTo", values=[0.3, 0, 0], gait=["MaxStepX", "StepHeight"], gait_values=[0.06, 0.03]))
    play(motion, f("moveTo", values=[0.3, 0, 0], duration=20.0, gait=["MaxStepX"], gait_values=[0.02]))
    assert moved(robot) == [
        ("moveTo", 0.3, 0.0, 0.0, 20.0),
        ("moveTo", 0.3, 0.0, 0.0, [["MaxStepX", 0.06], ["StepHeight", 0.03]]),
        ("moveTo", 0.3, 0.0, 0.0, 20.0, [["MaxStepX", 0.02]]),
    ]


def test_places_on_the_way_are_one_list(motion, robot):
    play(motion, f("moveTo", values=[0.3, 0, 0, 0.5, 0.2, 1.0]))
    assert moved(robot) == [("moveTo", [[0.3, 0.0, 0.0], [0.5, 0.2, 1.0]])]


@pytest.mark.parametrize("name", ["walkTarget", "walk_target"])
def test_a_target_in_the_world_is_walked_to_from_wherever_the_robot_is(motion, fake, name):
    fake.place = [1.0, 1.0, math.pi / 2]
    server = play(motion, f(name, values=[0.0, 2.0, math.pi], frame=1))
    assert server.end == "succeeded", server.text
    assert fake.place == pytest.approx([0.0, 2.0, math.pi])


def test_a_target_in_a_frame_of_tf(motion, fake, edge):
    edge.frames["table"] = (1.0, 0.5, math.pi / 2)
    fake.place = [0.0, 0.0, 0.0]
    play(motion, f("walkTarget", values=[0.2, 0.1, -math.pi / 2], str_param="table"))
    assert fake.place == pytest.approx([0.9, 0.7, 0.0])
    server = play(motion, f("walkTarget", values=[0.2, 0.1, 0.0], str_param="chair"))
    assert server.end == "aborted" and "the frame chair cannot be found" in server.text


def test_a_path_in_the_world_is_walked_through_as_seen_from_the_robot(motion, fake, robot):
    fake.place = [1.0, 0.0, math.pi / 2]
    play(motion, f("walkPath", values=[1.0, 0.5, math.pi / 2, 0.5, 0.5, math.pi], frame=1))
    ((method, points),) = moved(robot)
    assert method == "moveTo"
    assert points[0] == pytest.approx([0.5, 0.0, 0.0])
    assert points[1] == pytest.approx([0.5, 0.5, math.pi / 2])


def test_a_target_that_turns_out_to_be_too_far_is_not_walked_to(motion, fake, robot):
    fake.place = [-90.0, 0.0, 0.0]
    server = play(motion, f("walkTarget", values=[50.0, 0.0, 0.0], frame=1))
    assert server.end == "aborted" and "x cannot be 140" in server.text
    assert not any(call[0] == "moveTo" for call in moved(robot))


# Walks at a speed


def test_a_walk_at_a_speed_goes_on_after_its_goal(motion, fake, robot):
    server = play(motion, f("move", values=[0.1, 0, 0], gait=["LeftStepHeight", "Frequency"], gait_values=[0.03, 0.5]))
    assert server.end == "succeeded"
    assert moved(robot) == [("move", 0.1, 0.0, 0.0, [["LeftStepHeight", 0.03], ["Frequency", 0.5]])]
    assert fake.walking


def test_a_walk_for_a_while_ends_on_two_feet(motion, fake, edge, robot):
    server = play(motion, f("moveToward", values=[1, 0, 0], duration=0.02), f("moveIsActive"))
    assert (server.end, server.result.memList) == ("succeeded", ["False"])
    assert edge.clock.waits == [0.02]
    assert moved(robot) == [("moveToward", 1.0, 0.0, 0.0), *STOP]


def test_a_walk_for_a_while_that_somebody_stops_is_an_error(motion, fake, monkeypatch):
    monkeypatch.setattr(fake, "moveIsActive", lambda: False)
    server = play(motion, f("move", values=[0.1, 0, 0], duration=0.02))
    assert server.end == "aborted"
    assert "the walk was stopped (another client, a protection of the robot or a limit did that)" in server.text
    assert "the robot got to x 0.000 m, y 0.000 m, theta 0.000 rad" in server.text


def test_a_walk_that_a_goal_left_going_ends_with_the_node(motion, fake, edge):
    play(motion, f("move", values=[0.1, 0, 0]))
    play(motion, f("setAngles", names=["HeadYaw"], angles=[0.1]))
    assert fake.walking
    for action in edge.shutdown_actions:
        action()
    assert not fake.walking


def test_a_walk_of_somebody_else_does_not_end_with_the_node(motion, fake, edge):
    play(motion, f("moveTo", values=[0.1, 0, 0]))
    fake.move(0.1, 0.0, 0.0)
    for action in edge.shutdown_actions:
        action()
    assert fake.walking


# Footsteps


def test_footsteps_go_to_the_robot_as_rows(motion, robot):
    steps = [0.04, 0.1, 0.0, 0.04, -0.1, 0.2]
    legs = ["LLeg", "RLeg"]
    play(motion, f("setFootSteps", names=legs, values=steps, times=[0.6, 1.2], enable=True))
    play(motion, f("setFootStepsWithSpeed", names=legs, values=steps, speeds=[0.5]))
    play(motion, f("setFootStepsWithSpeed", names=legs, values=steps))
    rows = [steps[:3], steps[3:]]
    assert moved(robot) == [
        ("setFootSteps", legs, rows, [0.6, 1.2], True),
        ("setFootStepsWithSpeed", legs, rows, [0.5, 0.5], False),
        ("setFootStepsWithSpeed", legs, rows, [1.0, 1.0], False),
    ]


# Questions


def test_questions_about_the_walk(motion, fake):
    fake.place = [1.0, 2.0, 0.5]
    names = ("getRobotPosition", "getNextRobotPosition", "getRobotVelocity", "moveIsActive", "getFootSteps")
    result = play(motion, *map(f, names)).result
    assert result.memList[:10] == ["1.0", "2.0", "0.5"] * 2 + ["0.0"] * 3 + ["False"]
    assert json.loads(result.memList[10]) == [[0.0, 0.05, 0.0], [0.0, -0.05, 0.0]]
    pairs = play(motion, f("getMoveConfig", str_param="Max")).result.memList
    assert json.loads(pairs[0]) == ["MaxStepX", 0.08]


def test_distances_to_obstacles(motion, fake):
    play(motion, f("setOrthogonalSecurityDistance", values=[0.2]), f("setTangentialSecurityDistance", values=[0.05]))
    assert fake.distances == [0.2, 0.05]
    result = play(motion, f("getOrthogonalSecurityDistance"), f("getTangentialSecurityDistance")).result
    assert result.memList == ["0.2", "0.05"]


def test_each_arm_swings_as_it_is_told(motion, fake):
    play(motion, f("setMoveArmsEnabled", names=["RArm"], enable=False))
    assert fake.swing == [True, False]
    assert play(motion, f("getMoveArmsEnabled")).result.memList == ["True", "False"]
    play(motion, f("setMoveArmsEnabled", enable=False))
    assert fake.swing == [False, False]


# What is refused


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


# Ends


@pytest.mark.parametrize(
    "function",
    [
        f("moveTo", values=[1.0, 0, 0]),
        f("walkPath", values=[1.0, 0, 0, 2.0, 0, 0]),
        f("setFootStepsWithSpeed", names=["LLeg"], values=[0, 0.1, 0]),
        f("waitUntilMoveIsFinished"),
        f("moveInit"),
    ],
)
def test_a_preempted_walk_ends_on_two_feet(motion, fake, robot, function):
    method = "moveTo" if function.function == "walkPath" else function.function
    fake.slow.add(method)
    thread = play_until(motion, fake.started, f("setAngles", names=["HeadYaw"], angles=[0.1]), function)
    fake.slow.clear()
    motion.server.preempt()
    thread.join(LIMIT)
    assert (motion.server.end, fake.walking) == ("preempted", False)
    calls = [call[0] for call in moved(robot)]
    stopped = calls.index("stopMove")
    assert calls[stopped - 1] == method and calls[stopped + 1] == "waitUntilMoveIsFinished"
    assert not fake.pending[0].canceled, "a walk that is cancelled does not end on two feet"


def test_a_walk_that_goes_on_is_stopped_when_a_later_function_is_preempted(motion, fake, robot):
    fake.slow.add("angleInterpolation")
    wave = f("angleInterpolation", names=["LArm"], angles=[0.5], times=[5.0])
    thread = play_until(motion, fake.started, f("move", values=[0.1, 0, 0]), wave)
    assert fake.walking
    motion.server.preempt()
    thread.join(LIMIT)
    assert (motion.server.end, fake.walking) == ("preempted", False)
    assert moved(robot)[-1][0] == "killTasksUsingResources", "arms stop as well"


def test_a_walk_that_goes_on_is_stopped_in_the_wait_after_it(motion, fake, edge):
    thread = play_until(motion, edge.clock.waiting, f("move", values=[0.1, 0, 0], time=Duration.from_sec(60.0)))
    motion.server.preempt()
    thread.join(LIMIT)
    assert (motion.server.end, fake.walking) == ("preempted", False)


def test_a_walk_that_goes_on_is_stopped_when_a_later_function_fails(motion, fake):
    server = play(motion, f("move", values=[0.1, 0, 0]), f("getData", str_param="nowhere"))
    assert (server.end, fake.walking) == ("aborted", False)


def test_a_walk_that_somebody_stops_is_an_error_with_how_far_it_got(motion, fake):
    fake.slow.add("moveTo")
    thread = play_until(motion, fake.started, f("moveTo", values=[0.4, 0, 0]))
    fake.stopMove()
    thread.join(LIMIT)
    assert motion.server.end == "aborted"
    assert "(another client, a protection of the robot or a limit did that)" in motion.server.text
    assert "the robot got to x 0.100 m, y 0.000 m, theta 0.000 rad instead of x 0.400 m" in motion.server.text


def test_what_the_robot_says_about_the_end_of_a_walk_is_passed_on(motion, fake, robot):
    fake.slow.add("moveTo")
    thread = play_until(motion, fake.started, f("moveTo", values=[0.4, 0, 0]))
    robot.memory.signals["ALMotion/MoveFailed"](["an obstacle 0.33 m ahead", 1, [0.7, 0.0, 0.3]])
    fake.stopMove()
    thread.join(LIMIT)
    assert "the walk was stopped (an obstacle 0.33 m ahead): the robot got to x 0.100 m" in motion.server.text
    fake.slow.clear()
    fake.moveTo = lambda *_: False
    assert "another client" in play(motion, f("moveTo", values=[0.4, 0, 0])).text


def test_somebody_who_takes_the_walk_over_is_not_stopped(motion, fake, robot):
    def taken_over(*_):
        fake.walking = True
        return False

    fake.moveTo = taken_over
    assert play(motion, f("moveTo", values=[0.4, 0, 0])).end == "aborted"
    assert fake.walking
    assert ("stopMove",) not in moved(robot)


def test_a_fall_on_the_way_is_told_as_such(motion, fake, robot):
    fake.slow.add("moveTo")
    thread = play_until(
        motion, fake.started, f("moveTo", values=[0.4, 0, 0]), f("setAngles", names=["Head"], angles=[0.5])
    )
    robot.memory.signals["ALMotion/RobotIsFalling"](True)
    thread.join(LIMIT)
    assert motion.server.end == "aborted" and "function 1 (moveTo): the robot fell" in motion.server.text
    assert fake.angles["HeadYaw"] == 0.0


def test_a_walk_outside_of_a_goal_ends_on_two_feet_as_well(motion, fake):
    fake.slow.add("moveTo")
    ended = []

    def walk():
        try:
            motion.run("moveTo", ([0.4, 0.0, 0.0], 0.0, (), ()), 0.0)
        except Preempted:
            ended.append("preempted")

    thread = threading.Thread(target=walk, daemon=True)
    thread.start()
    assert fake.started.wait(LIMIT)
    motion.interrupt.trigger()
    thread.join(LIMIT)
    assert (ended, fake.walking) == (["preempted"], False)


def test_a_fall_ends_a_goal_that_only_waits_for_the_end_of_a_walk(motion, fake, robot):
    fake.slow.add("waitUntilMoveIsFinished")
    thread = play_until(motion, fake.started, f("waitUntilMoveIsFinished"))
    fake.slow.clear()
    robot.memory.signals["ALMotion/RobotIsFalling"](True)
    thread.join(LIMIT)
    assert motion.server.end == "aborted" and "the robot fell" in motion.server.text


def test_news_of_a_fall_that_come_later_than_the_end_of_the_walk_are_waited_for(motion, fake, robot):
    fall = threading.Timer(0.05, lambda: robot.memory.signals["ALMotion/RobotIsFalling"](True))
    fake.moveTo = lambda *_: False
    fake.waitUntilMoveIsFinished = fall.start
    assert "the robot fell" in play(motion, f("moveTo", values=[0.4, 0, 0])).text


def test_news_of_a_fall_that_come_with_the_end_of_the_walk_count(motion, fake, robot):
    def fall(*_):
        robot.memory.signals["ALMotion/RobotIsFalling"](True)
        return False

    fake.moveTo = fall
    server = play(motion, f("moveTo", values=[0.4, 0, 0]))
    assert "the robot fell" in server.text


def test_a_lost_robot_ends_the_goal_though_nobody_can_stop_it(motion, fake, robot, monkeypatch):
    fake.slow.add("moveTo")
    thread = play_until(motion, fake.started, f("moveTo", values=[0.4, 0, 0]))

    def nobody_there():
        raise RobotError("ALMotion", "stopMove", "no connection")

    monkeypatch.setattr(fake, "stopMove", nobody_there)
    robot.connection.become("lost", "unplugged")
    thread.join(LIMIT)
    assert motion.server.end == "aborted" and "went away: unplugged" in motion.server.text


def test_chains_of_legs_are_known(motion):
    play(motion, f("getAngles", names=["Head"]))
    assert motion.plan.walk.moved_joints() == [
        joint for chain in ("LLeg", "RLeg", "LArm", "RArm") for joint in CHAINS[chain] if not joint.endswith("Hand")
    ]
