"""Every end of a walk is on two feet."""

from __future__ import annotations

import threading

import pytest
from fake_motion import CHAINS
from genpy import Duration
from motion_walk_goals import LIMIT, f, moved, play, play_until

from nao_library_modules.errors import Preempted
from naoqi.errors import RobotError


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
